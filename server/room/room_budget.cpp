// Keeps a room within its time budget.

#include <string>

#include "core/definition.h"
#include "server/room/room.h"

namespace weft::server {

/// Applies the keeper's decisions as commands of the room itself. Ticks of `advance` have no clock
/// and do not count.
void Room::keep_budget(double seconds) {
  BudgetKeeper& budget = time_.budget();
  const BudgetKeeper::Setting before = budget.setting();
  const auto next = budget.add(seconds, solver_of(world_->def()) == SolverKind::verlet);
  if (!next) return;
  const bool softened = next->softness != before.softness;
  std::string what;
  if (softened) {
    world_->set_softness(next->softness);
    proto::Set command;
    command.softness = next->softness;
    order_.log.add(world_->tick(), 0, CommandOrigin::budget, command);
    what = "springs have " + number_text(next->softness) + " of their stiffness";
  } else {
    order_.log.add(world_->tick(), 0, CommandOrigin::budget, proto::Speed{speed()});
    follow_speed();
    what = "time passes at " + number_text(next->pace) + " of the wanted speed";
  }
  const bool full = next->pace >= 1 && next->softness >= time_.wanted_softness();
  news_.state = true;
  notify(full ? proto::NoticeLevel::info : proto::NoticeLevel::warning,
         full ? "within_budget" : "over_budget",
         "a budget of " + number_text(budget.budget().milliseconds) + " ms a tick: " + what, 0, {},
         softened ? next->softness : next->pace);
}

/// Sets a budget, and undoes the restrictions of the previous one.
void Room::ask_for_budget(const BudgetDef& budget) {
  const double softness = time_.wanted_softness();
  if (world_->softness() != softness) world_->set_softness(softness);
  time_.set_budget(budget);
  follow_speed();
}

/// Applies a changed speed.
void Room::follow_speed() {
  time_.restart_meter(clock_());
  output_.set_frame_rate(world_->def().tick_rate * speed());
}

}  // namespace weft::server
