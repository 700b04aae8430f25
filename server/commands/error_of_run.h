#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "core/world/run_error.h"

// What `weft simulate --error` prints.

namespace weft::server {

/// A run and its repetitions in double precision, because rounding in float hides the order of
/// small errors.
class ErrorOfRun {
 public:
  /// @param def  of the run
  ErrorOfRun(const WorldDef& def, const Runtime& runtime)
      : once_(def, runtime), error_(def, runtime, once_) {}

  /// What it will cost besides the run, in one line.
  /// @param run  cost of its ticks, at its start
  std::string cost_told_before(const TickCost& run) const;

  void step() {
    once_.step();
    error_.note_tick(once_);
  }

  /// The errors that were measured, with a `summary` in one line; "not measured" in the place of
  /// each figure that there is none of.
  nlohmann::ordered_json summary() const;

 private:
  World<double> once_;
  RunError<double> error_;
};

}  // namespace weft::server
