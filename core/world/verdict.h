#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/world/crossing_counter.h"
#include "core/world/world.h"

// Judges hard cases.

namespace weft {

/// Measures a hard case after each tick, and judges it in the end.
template <class Real>
class Verdict {
 public:
  /// Call after each tick.
  void look(const World<Real>& world);

  std::uint64_t ticks = 0;
  std::uint64_t crossings = 0;        ///< edges through triangles, over all judged ticks
  std::uint64_t crossed_ticks = 0;    ///< judged ticks with crossings
  std::uint64_t early_crossings = 0;  ///< before the judged ticks
  WorldCrossings crossing_now;        ///< in the last tick
  double deepest = 0;                 ///< penetration of an object in judged ticks [m]
  double smallest_gap = std::numeric_limits<double>::infinity();  ///< of near features [m]
  double largest_strain = 0;
  double lost_motion = 0;  ///< truncated motion over wanted motion, of the guard
  /// Largest energy in excess of the start, recorded work and disturbances, as a fraction of the
  /// energy in play: the largest mechanical energy plus all work.
  double energy_excess = 0;
  /// Distance from the rest shape to return to, as a fraction of its extent (both as root mean
  /// squares over the particles); NaN before it is measured.
  double rest_error = std::numeric_limits<double>::quiet_NaN();
  /// Largest change of a cloth's mean height from that rest [m]; NaN before it is measured.
  double height_error = std::numeric_limits<double>::quiet_NaN();
  double hands_lag = 0;  ///< largest distance of a held point from its hand's target [m]
  std::uint64_t recoveries = 0;
  bool finite = true;

  /// Violated limits, in words; empty if the case passes.
  std::vector<std::string> failures(const VerdictDef& def) const;

 private:
  void look_at_energy(const World<Real>& world);
  void look_at_rest(const World<Real>& world);
  void look_at_hands(const World<Real>& world);

  CrossingCounter<Real> counter_;
  std::optional<double> start_energy_;  ///< [J]
  double given_ = 0;                    ///< by work and disturbances since then [J]
  double at_play_ = 0, worked_ = 0;  ///< largest mechanical energy, and sum of all energy given [J]
  double excess_ = 0;                ///< [J]
  Vec3Array<Real> rest_;
};

extern template class Verdict<float>;
extern template class Verdict<double>;

}  // namespace weft
