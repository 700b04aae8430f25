// Compiles the passes for each instruction set and dispatches to them.

#include "core/contact/travel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/travel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/contact/travel-inl.h"

#if HWY_ONCE
#include <algorithm>
#include <array>
#include <cassert>

#include "core/contact/constants.h"
#include "core/contact/parts.h"
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(travel);
WEFT_EXPORT_KERNEL(deviation);

template <class Real>
bool run_travel(const TravelPass<Real>& pass, Executor* executor) {
  assert(pass.particles == 0 || (pass.x && pass.v && pass.from && pass.reach && pass.travel2));
  if (!executor || pass.particles < kLeastSharedTravel) return WEFT_RUN(travel, Real)(pass);
  std::array<bool, kTravelChunks> within;
  run_parts(executor, pass.particles, kTravelChunks,
            [&](std::size_t part, std::size_t first, std::size_t last) {
              TravelPass<Real> own = pass;
              own.particles = last - first;
              for (const Real** numbers : {&own.x, &own.v, &own.from}) *numbers += 3 * first;
              own.reach += first;
              own.travel2 += first;
              within[part] = WEFT_RUN(travel, Real)(own);
            });
  return std::all_of(within.begin(), within.end(), [](bool one) { return one; });
}

template <class Real>
Real largest_deviation(const PathPass<Real>& pass, Executor* executor) {
  assert(pass.particles == 0 || (pass.x && pass.v && pass.base && pass.velocity));
  if (!executor || pass.particles < kLeastSharedTravel) return WEFT_RUN(deviation, Real)(pass);
  std::array<Real, kTravelChunks> largest;
  run_parts(executor, pass.particles, kTravelChunks,
            [&](std::size_t part, std::size_t first, std::size_t last) {
              PathPass<Real> own = pass;
              own.particles = last - first;
              for (const Real** numbers : {&own.x, &own.v, &own.base, &own.velocity})
                *numbers += 3 * first;
              largest[part] = WEFT_RUN(deviation, Real)(own);
            });
  return *std::max_element(largest.begin(), largest.end());
}

WEFT_INSTANTIATE_FUNCTIONS(run_travel, largest_deviation)

}  // namespace weft
#endif
