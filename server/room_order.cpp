// In which order a room does what its viewers ask for, and what waits.

#include <algorithm>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/room.h"

namespace weft::server {
namespace {

/// Commands of one turn may take so long; then a tick gets its turn [s].
constexpr double kOrderSlice = 0.1;

/// A command below this is for nothing [s of CPU]. The viewer of a dearer one waits for
/// kWaitPerCost times as long before its next, if there are others.
constexpr double kFreeCost = 2e-3, kWaitPerCost = 3;

template <class Command>
bool is(const Inbound& item) {
  const auto* request = std::get_if<proto::Request>(&item.what);
  return request && std::holds_alternative<Command>(request->command);
}

/// Whether it neither looks at the cloth nor changes it, so that it may come while a tick passes.
bool is_beside_the_cloth(const Inbound& item) {
  return std::holds_alternative<Noted>(item.what) || is<proto::Hello>(item) ||
         is<proto::Camera>(item) || is<proto::Pause>(item) || is<proto::Resume>(item) ||
         is<proto::Speed>(item);
}

}  // namespace

void Room::take(Inbound item) {
  waiting_.push_back(std::move(item));
  work_off();
}

void Room::take_meanwhile(Inbound item) {
  const auto same_viewer = [&](const Inbound& other) { return other.viewer == item.viewer; };
  const bool first = std::none_of(waiting_.begin(), waiting_.end(), same_viewer);
  if (in_tick_ && first && !advance_ &&
      (is_beside_the_cloth(item) || std::holds_alternative<Join>(item.what)))
    return take_now(std::move(item));
  gives_up_ = gives_up_ || is<proto::Reset>(item);
  waiting_.push_back(std::move(item));
}

bool Room::gives_up() {
  over_limit_ = options_.limit && options_.limit->is_over();
  return over_limit_ || (in_tick_ && (gives_up_ || (building_ && building_->build->done())));
}

/// Whether it is not its turn. An `advance` and a `load` hold up their own viewer alone, whose
/// other commands come behind them; everything else is done between the ticks of an `advance`.
bool Room::must_wait(const Inbound& item) const {
  const auto viewer = viewers_.find(item.viewer);
  if (viewer == viewers_.end()) return false;
  if (advance_ && advance_->viewer == item.viewer && !is<proto::Pause>(item)) return true;
  if (building_ && (building_->viewer == item.viewer || is<proto::Load>(item))) return true;
  return viewer->second.next_turn > clock_();
}

/// Does what has come, in order; of each viewer nothing before what came earlier from it.
void Room::work_off() {
  finish_build();
  const double start = clock_();
  std::vector<proto::ViewerId> held;
  for (std::size_t k = 0; k < waiting_.size();) {
    Inbound& item = waiting_[k];
    if (std::holds_alternative<Leave>(item.what)) {
      let_go(item.viewer);
      k = 0;  // what it still wanted is gone
      held.clear();
      continue;
    }
    if (std::find(held.begin(), held.end(), item.viewer) != held.end() || must_wait(item)) {
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

/// Ends all that a viewer who has gone wanted. What only it would have heard is not done any more;
/// what it changed while it was here, it changed.
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

/// When something that waits has its turn [s].
double Room::next_turn() const {
  double next = clock_() + 1;
  for (const Inbound& item : waiting_) {
    const auto viewer = viewers_.find(item.viewer);
    if (viewer != viewers_.end()) next = std::min(next, viewer->second.next_turn);
  }
  return next;
}

/// Lets a viewer wait after a command that has cost others their time.
/// @param cost  of CPU [s]
void Room::charge(proto::ViewerId viewer, double cost) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end() || viewers_.size() < 2 || cost < kFreeCost) return;
  found->second.next_turn = clock_() + cost * kWaitPerCost;
}

/// Says that a tick was given up: it is in the log, so that a replay does the same.
void Room::note_halt() {
  const std::string cause =
      !tick_failure_.empty() ? "the server failed at it: " + tick_failure_
      : over_limit_
          ? "it took more than " + proto::number_text(options_.limit->seconds()) + " s of CPU"
          : "a command that replaces the state came";
  log_.add(world_->tick(), 0, CommandOrigin::limit, proto::Halt{cause});
  if (!over_limit_ && tick_failure_.empty()) return;
  log_.add(world_->tick(), 0, CommandOrigin::limit, proto::Pause{});
  paused_ = state_changed_ = frame_wanted_ = true;
  steps_left_ = 0;
  const std::string what = "tick " + std::to_string(world_->tick() + 1) + " was given up: " + cause;
  spdlog::warn("scene {}: {}", world_->def().name, what);
  metrics_.count_halt();
  notify(proto::NoticeLevel::warning, "halted",
         what + "; the room is paused. Let go, reset or load, or resume to try again");
  if (advance_) end_advance(proto::ErrorCode::halted, what, "reset, or take a lighter scene");
}

/// Ends an `advance` before it is done.
void Room::end_advance(proto::ErrorCode code, const std::string& why, const char* hint) {
  proto::Error error = proto::make_error(
      code, "the advance ended at tick " + std::to_string(world_->tick()) + ": " + why, hint);
  error.command = "advance";
  error.id = advance_->id;
  finish_advance(error);
}

}  // namespace weft::server
