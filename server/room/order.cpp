#include "server/room/order.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace weft::server {

bool is_beside_the_cloth(const Inbound& item) {
  return std::holds_alternative<Join>(item.what) || std::holds_alternative<Noted>(item.what) ||
         is<proto::Hello>(item) || is<proto::Camera>(item) || is<proto::Presence>(item) ||
         is<proto::Follow>(item) || is<proto::Lead>(item) || is<proto::Pause>(item) ||
         is<proto::Resume>(item) || is<proto::Speed>(item) || is<proto::Hash>(item) ||
         is<proto::ListRooms>(item) || is<proto::CloseRoom>(item);
}

bool is_about_rooms(const proto::Command& command) {
  return std::holds_alternative<proto::CreateRoom>(command) ||
         std::holds_alternative<proto::ListRooms>(command) ||
         std::holds_alternative<proto::Fork>(command) ||
         std::holds_alternative<proto::CloseRoom>(command);
}

bool is_for_its_viewer_alone(const Inbound& item) {
  return is<proto::Query>(item) || is<proto::Hash>(item) || is<proto::Pick>(item) ||
         is<proto::Advance>(item) || is<proto::Load>(item) || is<proto::CreateRoom>(item) ||
         is<proto::ListRooms>(item);
}

bool ends_its_advance(const Order& order, const Inbound& item) {
  return order.advance && order.advance->viewer == item.viewer && is<proto::Pause>(item);
}

bool is_held_up(const Order& order, const Inbound& item) {
  const std::optional<Advance>& advance = order.advance;
  if (advance && advance->viewer == item.viewer && !ends_its_advance(order, item)) return true;
  const std::optional<Building>& building = order.building;
  return building &&
         (building->viewer == item.viewer || is<proto::Load>(item) || is<proto::CreateRoom>(item));
}

void add_waiting(Order& order, Inbound item) {
  const auto last = std::find_if(order.waiting.rbegin(), order.waiting.rend(),
                                 [&](const Inbound& other) { return other.viewer == item.viewer; });
  const auto* newer = std::get_if<Noted>(&item.what);
  auto* note = last == order.waiting.rend() ? nullptr : std::get_if<Noted>(&last->what);
  if (!newer || !note) return order.waiting.push_back(std::move(item));
  last->number = item.number;
  note->wants_frame = note->wants_frame || newer->wants_frame;
  if (newer->forces) note->forces = newer->forces;
}

bool has_waiting(const Order& order, proto::ViewerId viewer) {
  return std::any_of(order.waiting.begin(), order.waiting.end(),
                     [viewer](const Inbound& item) { return item.viewer == viewer; });
}

std::vector<Inbound> take_waiting(Order& order, proto::ViewerId viewer) {
  std::deque<Inbound> others;
  std::vector<Inbound> own;
  for (Inbound& item : std::exchange(order.waiting, {}))
    item.viewer == viewer ? own.push_back(std::move(item)) : others.push_back(std::move(item));
  order.waiting = std::move(others);
  return own;
}

}  // namespace weft::server
