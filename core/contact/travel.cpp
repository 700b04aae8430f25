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

namespace weft {

HWY_EXPORT(travel_f32);
HWY_EXPORT(travel_f64);
HWY_EXPORT(deviation_f32);
HWY_EXPORT(deviation_f64);

namespace {

bool run_travel(const TravelPass<float>& pass) {
  return HWY_DYNAMIC_DISPATCH(travel_f32)(pass);
}

bool run_travel(const TravelPass<double>& pass) {
  return HWY_DYNAMIC_DISPATCH(travel_f64)(pass);
}

template <class Real>
bool run_travel_in_chunks(const TravelPass<Real>& pass, Executor* executor) {
  assert(pass.particles == 0 || (pass.x && pass.v && pass.from && pass.reach && pass.travel2));
  if (!executor || pass.particles < kLeastSharedTravel) return run_travel(pass);
  std::array<bool, kTravelChunks> within;
  run_parts(executor, pass.particles, kTravelChunks,
            [&](std::size_t part, std::size_t first, std::size_t last) {
              TravelPass<Real> own = pass;
              own.particles = last - first;
              for (const Real** numbers : {&own.x, &own.v, &own.from}) *numbers += 3 * first;
              own.reach += first;
              own.travel2 += first;
              within[part] = run_travel(own);
            });
  return std::all_of(within.begin(), within.end(), [](bool one) { return one; });
}

float run_deviation(const PathPass<float>& pass) {
  return HWY_DYNAMIC_DISPATCH(deviation_f32)(pass);
}

double run_deviation(const PathPass<double>& pass) {
  return HWY_DYNAMIC_DISPATCH(deviation_f64)(pass);
}

template <class Real>
Real deviation_in_chunks(const PathPass<Real>& pass, Executor* executor) {
  assert(pass.particles == 0 || (pass.x && pass.v && pass.base && pass.velocity));
  if (!executor || pass.particles < kLeastSharedTravel) return run_deviation(pass);
  std::array<Real, kTravelChunks> largest;
  run_parts(executor, pass.particles, kTravelChunks,
            [&](std::size_t part, std::size_t first, std::size_t last) {
              PathPass<Real> own = pass;
              own.particles = last - first;
              for (const Real** numbers : {&own.x, &own.v, &own.base, &own.velocity})
                *numbers += 3 * first;
              largest[part] = run_deviation(own);
            });
  return *std::max_element(largest.begin(), largest.end());
}

}  // namespace

bool measure_travel(const TravelPass<float>& pass, Executor* executor) {
  return run_travel_in_chunks(pass, executor);
}

bool measure_travel(const TravelPass<double>& pass, Executor* executor) {
  return run_travel_in_chunks(pass, executor);
}

float largest_deviation(const PathPass<float>& pass, Executor* executor) {
  return deviation_in_chunks(pass, executor);
}

double largest_deviation(const PathPass<double>& pass, Executor* executor) {
  return deviation_in_chunks(pass, executor);
}

}  // namespace weft
#endif
