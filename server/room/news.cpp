#include "server/room/news.h"

#include <utility>

namespace weft::server {
namespace {

/// @returns whether they differ
template <class List>
bool replace(List& old, List present) {
  if (present == old) return false;
  old = std::move(present);
  return true;
}

}  // namespace

void News::add(proto::Notice notice) {
  std::erase_if(notices, [&notice](const proto::Notice& waiting) {
    return waiting.code == notice.code && waiting.message == notice.message &&
           waiting.viewer == notice.viewer && waiting.drag == notice.drag;
  });
  notices.push_back(std::move(notice));
}

bool note_sleep(const ServedWorld& world, Told& told) {
  if (world.sleep().asleep() == told.asleep) return false;
  told.asleep = world.sleep().asleep();
  return true;
}

bool note_pins(const ServedWorld& world, Told& told) {
  std::vector<PinId> moving;
  for (const Pin& pin : world.pins().list)
    if (pin.path) moving.push_back(pin.id);
  return replace(told.moving_pins, std::move(moving));
}

bool note_grabs(const ServedWorld& world, Told& told) {
  std::vector<GrabId> held;
  for (const Grab<float>& grab : world.grabs().list)
    if (world.scene_hand(grab.id)) held.push_back(grab.id);
  return replace(told.scene_grabs, std::move(held));
}

}  // namespace weft::server
