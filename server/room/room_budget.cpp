// What `set` sets in a room, and how it keeps within its time budget.

#include <cassert>
#include <memory>
#include <string>
#include <utility>

#include "core/definition.h"
#include "core/world/cost.h"
#include "core/world/substep_causes.h"
#include "server/room/room.h"
#include "server/translate/translate_settings.h"

namespace weft::server {
namespace {

/// Throws CostError if ticks of a cloth's new fabric cost too much.
void check_fabric(const ServedWorld& changed, std::size_t cloth) {
  try {
    check_cost(changed.cost_in(changed.environment()), "fabric", "too costly");
  } catch (CostError& error) {
    error.causes = substep_causes(changed.model().parts[cloth], solver_of(changed.def()),
                                  changed.tick_seconds())
                       .fields;
    throw;
  }
}

/// A world with what is wanted of fabric and softness; null if that is what it has. Throws
/// DefinitionError if it cannot be, or costs too much.
std::unique_ptr<ServedWorld> changed_world(const ServedWorld& world,
                                           const std::optional<FabricWanted>& fabric,
                                           double softness) {
  std::unique_ptr<ServedWorld> changed;
  if (fabric) changed = world.with_fabric(fabric->cloth, fabric->fabric);
  if (softness != world.softness()) {
    if (!changed) changed = world.fork();
    changed->set_softness(softness);
  }
  if (fabric) check_fabric(*changed, fabric->cloth);
  return changed;
}

}  // namespace

/// The softness that a `set` leads to. A budget's softening is taken back where another budget is
/// set; and where another fabric is, so that its cost is known.
double Room::softness_after(const proto::Set& command) const {
  if (command.softness) return *command.softness;
  const bool anew = command.fabric || command.budget_ms || command.over_budget;
  return anew ? time_.wanted_softness() : world_->softness();
}

Room::Outcome Room::apply(proto::ViewerId, const proto::Set& command) {
  const auto fabric = fabric_wanted(*world_, command);
  if (!fabric) return fabric.error();
  const std::optional<FabricWanted>& wanted = *fabric;
  std::unique_ptr<ServedWorld> changed;  // replaces the present world once nothing can fail
  const auto change = [&] { changed = changed_world(*world_, wanted, softness_after(command)); };
  try {
    if (!within_limit(change, kBetweenTicks)) throw Stopped();
  } catch (const DefinitionError& error) {
    return error.field == "softness" ? refused_softness(error, command)
                                     : refused_fabric(error, command);
  }
  const EnvironmentDef environment = with_settings(world_->environment(), command);
  TickCost cost;
  try {
    validate(environment);
    cost = (changed ? changed : world_)->cost_in(environment);
    check_cost(cost, "environment", "this air");
  } catch (const DefinitionError& error) {
    return refused_environment(error, command);
  }
  if (options_.others) {
    if (auto error = options_.others->admit(options_.name, cost)) return *std::move(error);
  }
  const bool softened = changed && changed->softness() != world_->softness();
  if (changed) {
    world_ = std::move(changed);
    frames_.note_command();
  }
  if (softened && !command.softness) log_softness();
  if (wanted)
    mesh_.cloths[wanted->cloth].thickness =
        wanted->fabric.thickness;  // for viewers that join later
  world_->set_environment(environment);
  if (command.softness) time_.set_softness(*command.softness);
  if (softened || command.softness || command.budget_ms || command.over_budget)
    ask_for_budget(with_settings(time_.budget().budget(), command));
  news_.state = true;
  if (forces_.measured) frames_.note_command();  // the forces of the coming tick have changed
  return proto::Reply(proto::DoneReply{"set", world_->tick()});
}

/// Notes a softness that the budget gives or takes back, so that a replay does the same.
void Room::log_softness() {
  proto::Set command;
  command.softness = world_->softness();
  order_.log.add(world_->tick(), 0, CommandOrigin::budget, command);
}

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
    try {
      world_->set_softness(next->softness);
    } catch (const DefinitionError&) {  // stretched cloth would be thrown; it may be calmer later
      budget.restart(budget.budget(), before, time_.wanted_softness());
      return;
    }
    log_softness();
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

/// Sets a budget, without the restrictions of the previous one.
void Room::ask_for_budget(const BudgetDef& budget) {
  assert(world_->softness() == time_.wanted_softness());
  time_.set_budget(budget);
  follow_speed();
}

/// Applies a changed speed.
void Room::follow_speed() {
  time_.restart_meter(clock_());
  output_.set_frame_rate(world_->def().tick_rate * speed());
}

}  // namespace weft::server
