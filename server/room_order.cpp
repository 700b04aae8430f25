// The order in which a room runs its viewers' commands, and which of them wait.

#include <algorithm>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/room.h"

namespace weft::server {
namespace {

template <class Command>
bool is(const Inbound& item) {
  const auto* request = std::get_if<proto::Request>(&item.what);
  return request && std::holds_alternative<Command>(request->command);
}

/// Whether it changes nothing of the cloth and needs no more of it than is known during a tick.
bool is_beside_the_cloth(const Inbound& item) {
  return std::holds_alternative<Join>(item.what) || std::holds_alternative<Noted>(item.what) ||
         is<proto::Hello>(item) || is<proto::Camera>(item) || is<proto::Pause>(item) ||
         is<proto::Resume>(item) || is<proto::Speed>(item) || is<proto::Hash>(item);
}

}  // namespace

void Room::take(Inbound item) {
  waiting_.push_back(std::move(item));
  work_off();
}

void Room::take_meanwhile(Inbound item) {
  const bool may_run = may_run_meanwhile(item);
  if (in_tick_ && may_run && is_beside_the_cloth(item)) return take_now(std::move(item));
  gives_up_ = gives_up_ || (may_run && is<proto::Reset>(item));
  waiting_.push_back(std::move(item));
}

/// Whether it is its viewer's turn during a tick.
bool Room::may_run_meanwhile(const Inbound& item) const {
  if (ends_its_advance(item)) return true;
  const auto same_viewer = [&](const Inbound& other) { return other.viewer == item.viewer; };
  return std::none_of(waiting_.begin(), waiting_.end(), same_viewer) && !must_wait(item);
}

/// Whether it is a pause by the viewer of the running `advance`, which waits for nothing.
bool Room::ends_its_advance(const Inbound& item) const {
  return advance_ && advance_->viewer == item.viewer && is<proto::Pause>(item);
}

bool Room::gives_up() {
  over_limit_ = options_.limit && options_.limit->is_over();
  return over_limit_ || (in_tick_ && (gives_up_ || (building_ && building_->build->succeeded())));
}

/// Whether it has to wait. An `advance` and a `load` hold up only the later commands of their own
/// viewer; all other commands run between the ticks of an `advance`.
bool Room::must_wait(const Inbound& item) const {
  const auto viewer = viewers_.find(item.viewer);
  if (viewer == viewers_.end()) return false;
  if (advance_ && advance_->viewer == item.viewer && !ends_its_advance(item)) return true;
  if (building_ && (building_->viewer == item.viewer || is<proto::Load>(item))) return true;
  return viewer->second.next_turn > clock_();
}

/// Runs the waiting items in order; those of one viewer never overtake each other, except a pause
/// that ends its own advance, behind which the others wait.
void Room::work_off() {
  finish_build();
  const double start = clock_();
  std::vector<proto::ViewerId> held;
  for (std::size_t k = 0; k < waiting_.size();) {
    Inbound& item = waiting_[k];
    if (std::holds_alternative<Leave>(item.what)) {
      let_go(item.viewer);
      k = 0;  // its other waiting commands are gone
      held.clear();
      continue;
    }
    const bool behind = std::find(held.begin(), held.end(), item.viewer) != held.end();
    if ((behind && !ends_its_advance(item)) || must_wait(item)) {
      held.push_back(item.viewer);
      ++k;
      continue;
    }
    Inbound next = std::move(item);
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(k));
    take_now(std::move(next));
    if (clock_() - start > kOrderSlice) break;
  }
}

/// Drops the waiting commands of a viewer that has left: those whose answer only it would have
/// received. Changes that it has already made stay.
void Room::let_go(proto::ViewerId viewer) {
  if (advance_ && advance_->viewer == viewer) {
    log_.shorten_advance(advance_->left);
    advance_.reset();
  }
  if (const auto found = viewers_.find(viewer); found != viewers_.end())
    found->second.next_turn = 0;
  std::deque<Inbound> left;
  std::vector<Inbound> its_own;
  for (Inbound& item : std::exchange(waiting_, {}))
    item.viewer == viewer ? its_own.push_back(std::move(item)) : left.push_back(std::move(item));
  waiting_ = std::move(left);
  for (Inbound& item : its_own) {
    const bool for_nobody = is<proto::Query>(item) || is<proto::Hash>(item) ||
                            is<proto::Pick>(item) || is<proto::Advance>(item) ||
                            is<proto::Load>(item);
    if (!for_nobody) take_now(std::move(item));
    if (for_nobody) on_finished(viewer);
  }
}

/// Earliest turn of a waiting command [s].
double Room::next_turn() const {
  double next = clock_() + 1;
  for (const Inbound& item : waiting_) {
    const auto viewer = viewers_.find(item.viewer);
    if (viewer != viewers_.end()) next = std::min(next, viewer->second.next_turn);
  }
  return next;
}

/// Makes a viewer wait after a command that has cost others their time.
/// @param cost  of CPU [s]
void Room::charge(proto::ViewerId viewer, double cost) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end() || viewers_.size() < 2 || cost < kFreeCost) return;
  found->second.next_turn = clock_() + cost * kWaitPerCost;
}

/// Announces a tick that was given up, and logs it, so that a replay does the same.
void Room::note_halt() {
  const std::string cause =
      !tick_failure_.empty() ? "the server failed: " + tick_failure_
      : over_limit_
          ? "it took more than " + proto::number_text(options_.limit->seconds()) + " s of CPU"
          : "a command that replaces the state arrived";
  log_.add(world_->tick(), 0, CommandOrigin::limit, proto::Halt{cause});
  if (!over_limit_ && tick_failure_.empty()) return;
  log_.add(world_->tick(), 0, CommandOrigin::limit, proto::Pause{});
  time_.pause();
  change(&News::state);
  const std::string what = "tick " + std::to_string(world_->tick() + 1) + " was given up: " + cause;
  spdlog::warn("scene {}: {}", world_->def().name, what);
  metrics_.count_halt();
  notify(proto::NoticeLevel::warning, "halted",
         what + "; the room is paused. Let go, reset or load, or resume to try again");
  if (advance_) end_advance(proto::ErrorCode::halted, what, "reset, or take a lighter scene");
}

/// Ends an `advance` early.
void Room::end_advance(proto::ErrorCode code, const std::string& why, const char* hint) {
  proto::Error error = proto::make_error(
      code, "the advance ended at tick " + std::to_string(world_->tick()) + ": " + why, hint);
  error.command = "advance";
  error.id = advance_->id;
  finish_advance(error);
}

}  // namespace weft::server
