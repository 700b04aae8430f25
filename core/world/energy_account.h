#pragma once

#include "core/solver/verlet.h"

namespace weft {

/// Keeps book of the energy that the cloth can have, so that a runaway is seen in the tick in which
/// it starts to matter, and a hand that pulls hard is not taken for one.
///
/// Mechanical energy (kinetic and elastic) can only come from the start, from falling, and from the
/// work of hands and air. Losses are not booked at once: what is unexplained leaks away over a
/// second or so, because close to the stability limit the energy of the highest modes, summed at
/// one instant, swings by a factor of ten while nothing is wrong.
class EnergyAccount {
 public:
  /// @param total_mass  of the cloth [kg]
  explicit EnergyAccount(double total_mass) : floor_(total_mass * kFloorSpeed * kFloorSpeed / 2) {}

  /// Starts anew, at the next tick's initial energy.
  void clear() { credit_ = 0; }

  /// Whether the result of a tick cannot be explained. NaN counts as such.
  bool is_runaway(const AdvanceResult& tick) const {
    return !(mechanical(tick.after) <= kSlack * (booked(tick) + floor_));
  }

  /// Energy without a source [J], for the report.
  double unexplained(const AdvanceResult& tick) const {
    return mechanical(tick.after) - booked(tick);
  }

  /// Books a tick that was accepted.
  void accept(const AdvanceResult& tick) {
    const double now = mechanical(tick.after), have = booked(tick);
    credit_ = have > now ? now + (have - now) * kKept : have;
  }

 private:
  static constexpr double kSlack = 20;      // swing of the highest modes, twice
  static constexpr double kKept = 0.95;     // part of the unexplained credit kept each tick
  static constexpr double kFloorSpeed = 1;  // energy of this speed is never suspicious [m/s]

  static double mechanical(const Energies& e) { return e.kinetic + e.stretch + e.bending; }

  /// What the cloth may have after the tick. Commands between ticks (a new pin, other gravity)
  /// change the energy at its start, which is therefore the least of it.
  double booked(const AdvanceResult& tick) const {
    const double start = mechanical(tick.before) > credit_ ? mechanical(tick.before) : credit_;
    const double fallen = tick.before.gravity - tick.after.gravity;
    return start + (fallen > 0 ? fallen : 0) + (tick.work > 0 ? tick.work : 0);
  }

  double floor_;
  double credit_ = 0;
};

}  // namespace weft
