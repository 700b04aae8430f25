#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/world/crossing_counter.h"
#include "core/world/world.h"

namespace weft {

/// What is looked at after each tick of a hard case, and what it says in the end.
template <class Real>
class Verdict {
 public:
  /// To be called after each tick.
  void look(const World<Real>& world);

  std::uint64_t ticks = 0;
  std::uint64_t crossings = 0;        ///< of edges through triangles, over all ticks that count
  std::uint64_t crossed_ticks = 0;    ///< ticks that count with any of them
  std::uint64_t early_crossings = 0;  ///< before the ticks that count
  WorldCrossings crossing_now;        ///< in the tick looked at last
  double deepest = 0;                 ///< into an object, in ticks that count [m]
  double smallest_gap = std::numeric_limits<double>::infinity();  ///< of near features [m]
  double largest_strain = 0;
  double lost_motion = 0;  ///< truncated by wanted motion, of the guard
  /// Largest energy beyond that at the start, what was logged as work and what insults brought, as
  /// a part of the energy that was at play: of motion and stretch at most, and of all work.
  double energy_excess = 0;
  /// Distance from the rest that it shall come back to, as a part of its extent (both as root mean
  /// squares over the particles); NaN before that is looked at.
  double rest_error = std::numeric_limits<double>::quiet_NaN();
  /// Largest change of a cloth's mean height from that rest [m]; NaN before that is looked at.
  double height_error = std::numeric_limits<double>::quiet_NaN();
  double hands_lag = 0;  ///< largest distance of what a hand holds from its target [m]
  std::uint64_t recoveries = 0;
  bool finite = true;

  /// What the case does not keep to, in words; nothing: it passes.
  std::vector<std::string> failures(const VerdictDef& def) const;

 private:
  void look_at_energy(const World<Real>& world);
  void look_at_rest(const World<Real>& world);
  void look_at_hands(const World<Real>& world);

  CrossingCounter<Real> counter_;
  std::optional<double> start_energy_;  ///< [J]
  double given_ = 0;                    ///< by work and insults since [J]
  double at_play_ = 0, worked_ = 0;  ///< most mechanical energy, and sum of all that is given [J]
  double excess_ = 0;                ///< [J]
  Vec3Array<Real> rest_;
};

extern template class Verdict<float>;
extern template class Verdict<double>;

}  // namespace weft
