#pragma once

#include "core/definition.h"

namespace weft {

/// What a room does that needs more time for its ticks than it may.
enum class OverBudget {
  slow,    ///< simulated time passes more slowly
  soften,  ///< the springs become softer, so that fewer substeps do; then time slows down
};

/// The time that a scene asks to be kept to. A world knows no clock: whoever steps it measures,
/// decides, and makes the change by a command.
struct BudgetDef {
  double milliseconds = 0;  ///< for each tick that is due, at the tick rate [ms]; 0: no bound
  OverBudget remedy = OverBudget::slow;
};

template <class Def, class Visitor>
void visit_fields_of_budget(Def& def, Visitor&& visit) {
  visit(FieldInfo{"milliseconds", 0, 1000, "ms", "time for each tick that is due; 0: no bound"},
        def.milliseconds);
  visit(choice("remedy", "slow|soften", "over it: slower time, or softer springs first"),
        def.remedy);
}

}  // namespace weft
