// The order in which a room runs its viewers' commands, and which of them wait.

#include <algorithm>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/room/room.h"

namespace weft::server {
void Room::take(Inbound item) {
  add_waiting(order_, std::move(item));
  work_off();
}

void Room::take_meanwhile(Inbound item) {
  const bool may_run = may_run_meanwhile(item);
  // What follows a pause is about the state that stands.
  const bool stands_next = order_.advance ? order_.advance->paused : paused();
  const bool waits = stands_next && is<proto::Hash>(item);
  if (tick_.runs && may_run && !waits && is_beside_the_cloth(item))
    return take_now(std::move(item));
  if (ends_its_advance(order_, item)) order_.advance->paused = true;
  tick_.replaced = tick_.replaced || (may_run && replaces_state(item));
  add_waiting(order_, std::move(item));
}

/// Whether it will make the tick that runs worthless.
bool Room::replaces_state(const Inbound& item) const {
  const auto* request = std::get_if<proto::Request>(&item.what);
  const auto* restore = request ? std::get_if<proto::Restore>(&request->command) : nullptr;
  return is<proto::Reset>(item) || (restore && saves_.find(restore->name).has_value());
}

/// Whether it is its viewer's turn during a tick.
bool Room::may_run_meanwhile(const Inbound& item) const {
  return !has_waiting(order_, item.viewer) && !must_wait(item);
}

bool Room::gives_up() {
  tick_.over_limit = options_.limit && options_.limit->is_over();
  return tick_.over_limit ||
         (tick_.runs && (tick_.replaced || (order_.building && order_.building->replaces())));
}

/// Whether it has to wait: for what is under way, or because its viewer has cost others their time.
bool Room::must_wait(const Inbound& item) const {
  const auto viewer = viewers_.find(item.viewer);
  if (viewer == viewers_.end()) return false;
  const bool looks =
      std::holds_alternative<proto::Request>(item.what) && only_looks(viewer->second);
  const double turn = std::max(viewer->second.next_turn, looks ? order_.looks_from : 0);
  return is_held_up(order_, item) || turn > clock_();
}

/// Runs the waiting items in their order.
void Room::work_off() {
  finish_build();
  const double start = clock_();
  std::vector<proto::ViewerId> held;
  for (std::size_t k = 0; k < order_.waiting.size();) {
    Inbound& item = order_.waiting[k];
    if (std::holds_alternative<Leave>(item.what)) {
      let_go(item.viewer);
      k = 0;  // its other waiting commands are gone
      held.clear();
      continue;
    }
    const bool behind = std::find(held.begin(), held.end(), item.viewer) != held.end();
    if (ends_its_advance(order_, item) && (behind || must_wait(item))) {
      end_paused_advance();
      k = 0;  // what waited for that goes first
      held.clear();
      continue;
    }
    if (behind || must_wait(item)) {
      held.push_back(item.viewer);
      ++k;
      continue;
    }
    Inbound next = std::move(item);
    order_.waiting.erase(order_.waiting.begin() + static_cast<std::ptrdiff_t>(k));
    take_now(std::move(next));
    if (clock_() - start > kOrderSlice) break;
  }
}

/// Drops the waiting commands of a viewer that has left: those whose answer only it would have
/// received. Changes that it has already made stay.
void Room::let_go(proto::ViewerId viewer) {
  if (order_.advance && order_.advance->viewer == viewer) {
    order_.log.shorten_advance(order_.advance->left);
    order_.advance.reset();
  }
  if (const auto found = viewers_.find(viewer); found != viewers_.end())
    found->second.next_turn = 0;
  for (Inbound& item : take_waiting(order_, viewer)) {
    const bool drops = is_for_its_viewer_alone(item);
    if (!drops) take_now(std::move(item));
    if (drops) on_finished(viewer);
  }
}

/// Earliest turn of a waiting command [s].
double Room::next_turn() const {
  double next = clock_() + 1;
  for (const Inbound& item : order_.waiting) {
    const auto viewer = viewers_.find(item.viewer);
    if (viewer == viewers_.end()) continue;
    const double looks_from = only_looks(viewer->second) ? order_.looks_from : 0;
    next = std::min(next, std::max(viewer->second.next_turn, looks_from));
  }
  return next;
}

/// Makes a viewer wait after a command that has cost others their time. Those that may only look
/// wait together after any, so that all of them take a quarter of the room's time at most.
/// @param cost  of CPU [s]
void Room::charge(proto::ViewerId viewer, double cost) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  if (only_looks(found->second)) order_.looks_from = clock_() + cost * kWaitPerCost;
  if (cost < kFreeCost) return;
  found->second.next_turn = clock_() + cost * kWaitPerCost;
}

/// Announces a tick that was given up, and logs it, so that a replay does the same.
void Room::note_halt() {
  const std::string cause =
      !tick_.failure.empty() ? "the server failed: " + tick_.failure
      : tick_.over_limit
          ? "it took more than " + proto::number_text(options_.limit->seconds()) + " s of CPU"
          : "a command that replaces the state arrived";
  order_.log.add(world_->tick(), 0, CommandOrigin::limit, proto::Halt{cause});
  if (!tick_.over_limit && tick_.failure.empty()) return;
  order_.log.add(world_->tick(), 0, CommandOrigin::limit, proto::Pause{});
  time_.pause();
  change(&News::state);
  const std::string what = "tick " + std::to_string(world_->tick() + 1) + " was given up: " + cause;
  spdlog::warn("scene {}: {}", world_->def().name, what);
  metrics_.count_halt();
  notify(proto::NoticeLevel::warning, "halted",
         what +
             "; the room is paused. Let go, take back what was set last, reset or load, or resume "
             "to try again");
  if (order_.advance) end_advance(proto::ErrorCode::halted, what, "reset, or take a lighter scene");
}

/// Ends an `advance` early.
void Room::end_advance(proto::ErrorCode code, const std::string& why, const char* hint) {
  proto::Error error = proto::make_error(
      code, "the advance ended at tick " + std::to_string(world_->tick()) + ": " + why, hint);
  error.command = "advance";
  error.id = order_.advance->id;
  finish_advance(error);
}

}  // namespace weft::server
