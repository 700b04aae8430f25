#pragma once

#include <cassert>

#include "core/solver/verlet.h"
#include "core/world/constants.h"

// Detects energy that has no source.

namespace weft {

/// Accounts for the energy of the cloth, so that a runaway is detected in the tick in which it
/// begins to matter, and a strong pull of a hand is not mistaken for one.
///
/// Mechanical energy (kinetic and elastic) can only come from the start, from falling, and from the
/// work of hands, air, objects and pins. Losses are not deducted at once: unexplained energy decays
/// over about a second (kCreditSeconds), because close to the stability limit the energy of the
/// highest modes, summed at one instant, varies by a factor of ten in normal operation.
class EnergyAccount {
 public:
  /// @param total_mass  of the cloth [kg]
  explicit EnergyAccount(double total_mass)
      : floor_(total_mass * kUnsuspiciousSpeed * kUnsuspiciousSpeed / 2) {
    assert(total_mass >= 0);
  }

  /// Restarts with the next tick's initial energy.
  void clear() { credit_ = 0; }

  /// Whether the result of a tick cannot be explained. NaN counts as unexplained.
  bool is_runaway(const AdvanceResult& tick) const {
    return !(tick.after.mechanical() <= kRunawayFactor * (booked(tick) + floor_));
  }

  /// Energy without a source [J], for reports.
  double unexplained(const AdvanceResult& tick) const {
    return tick.after.mechanical() - booked(tick);
  }

  /// Accounts for an accepted tick.
  /// @param seconds  its length
  void accept(const AdvanceResult& tick, double seconds) {
    assert(seconds > 0);
    const double now = tick.after.mechanical(), have = booked(tick);
    credit_ = have > now ? now + (have - now) / (1 + seconds / kCreditSeconds) : have;
  }

 private:
  /// Energy that the cloth may have after the tick. Commands between ticks (a new pin, other
  /// gravity) change the energy at its start, which is therefore the minimum.
  double booked(const AdvanceResult& tick) const {
    const double had = tick.before.mechanical(), start = had > credit_ ? had : credit_;
    const double fallen = tick.before.gravity - tick.after.gravity;
    return start + (fallen > 0 ? fallen : 0) + (tick.work > 0 ? tick.work : 0);
  }

  double floor_;
  double credit_ = 0;
};

}  // namespace weft
