#pragma once

#include "core/definition.h"

// Time budget of a scene.

namespace weft {

/// Remedy of a world whose ticks exceed their time budget.
enum class OverBudget {
  slow,    ///< simulated time passes more slowly
  soften,  ///< softer springs, so that fewer substeps suffice; then slower time
};

/// The time budget of a scene. A world has no clock: its owner measures, decides, and changes the
/// setting by a command.
struct BudgetDef {
  double milliseconds = 0;  ///< for each due tick, at the tick rate [ms]; 0: no bound
  OverBudget remedy = OverBudget::slow;
};

template <class Def, class Visitor>
void visit_fields_of_budget(Def& def, Visitor&& visit) {
  visit(FieldInfo{"milliseconds", kBudgetRange, "ms", "time budget of each due tick; 0: no bound"},
        def.milliseconds);
  visit(choice("remedy", "slow|soften", "over budget: slower time, or softer springs first"),
        def.remedy);
}

}  // namespace weft
