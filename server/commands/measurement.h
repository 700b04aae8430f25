#pragma once

#include <cstddef>
#include <vector>

#include "core/profile.h"
#include "core/world/crossing_counter.h"
#include "core/world/verdict.h"
#include "core/world/world.h"
#include "server/translate/translate_guarantee.h"
#include "server/work_limit.h"

// What a run of `simulate` measures.

namespace weft::server {

template <class Real>
struct Measurement {
  double cpu = 0, wall = 0;   ///< of the steps alone [s]
  std::vector<double> ticks;  ///< [s], sorted
  Profile stages;             ///< summed
  double deepest = 0;         ///< [m]
  int checks = 0;             ///< ticks checked for penetrations and crossings
  int divergences = 0;
  int stopped = 0;          ///< those after which the cloth went back and was stopped
  int damped_substeps = 0;  ///< that `implicit` repeated by backward Euler
  int least_substeps = 0, most_substeps = 0;
  double largest_strain = 0;  ///< over the whole run
  std::size_t cloth_crossings =
      0;  ///< of the cloths with themselves and each other, over all checks
  std::size_t object_crossings = 0;          ///< of cloths with objects, over all checks
  int crossed_ticks = 0, first_crossed = 0;  ///< number of the first one; 0: none
  std::size_t late_crossings = 0;            ///< after the scene's grace time for crossings
  std::size_t broken_promises = 0;           ///< those that its contact rules out
  std::size_t while_led_out = 0;  ///< the same of cloth that started badly, until it is out
  Verdict<Real> verdict;          // of a hard case
  proto::Guarantee guarantee;     ///< at the end
  bool halted = false;            ///< the tick after these was given up
};

/// Whether the cloth went back to its last good state in a tick and was stopped.
inline bool was_stopped(const TickReport& tick) {
  return tick.divergence && tick.divergence->remedy == DivergenceRemedy::stopped_cloth;
}

/// Steps the world and measures that.
/// @returns false if the tick exceeded its limit; the state is then unchanged
template <class Real>
bool measure_tick(World<Real>& world, WorkLimit& limit, Measurement<Real>& m);

/// Checks for penetrations and counts crossings.
/// @param judged   `m.verdict` has counted them
/// @param led_out  cloth that started inside objects or through cloth is not out yet
template <class Real>
void look(World<Real>& world, bool judged, bool led_out, CrossingCounter<Real>& counter,
          Measurement<Real>& m);

}  // namespace weft::server
