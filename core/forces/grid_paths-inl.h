// Displacements of a grid's particles from straight paths.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_PATHS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_PATHS_INL_H
#undef WEFT_GRID_PATHS_INL_H
#else
#define WEFT_GRID_PATHS_INL_H
#endif

#include <limits>

#include "core/forces/grid_layout-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Extends the bounds by the displacement of each of `count` numbers from its straight path;
/// `count` is at least the width of a vector.
/// @param base, velocity  of the paths
template <class D, class V = hn::Vec<D>, class Real = hn::TFromD<D>>
HWY_INLINE void widen(D d, const Real* x, const Real* base, const Real* velocity, Real time,
                      std::ptrdiff_t count, V& least, V& most) {
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const V t = hn::Set(d, time);
  for (std::ptrdiff_t c = 0; c < count; c += lanes) {
    // The last vector may overlap the previous one.
    const std::ptrdiff_t at = std::min(c, count - lanes);
    const V path = hn::Add(hn::LoadU(d, base + at), hn::Mul(hn::LoadU(d, velocity + at), t));
    const V off = hn::Sub(hn::LoadU(d, x + at), path);
    least = hn::Min(least, off);
    most = hn::Max(most, off);
  }
}

/// Bounding box of all particles' displacements from their straight paths; minima and maxima are
/// the same for any vector width.
/// @param paths  six lines per row: positions at time 0 [m], velocities along the paths [m/s]
/// @param box    receives the lower and the upper corner [m]
template <class Real>
HWY_ATTR void box_paths(const GridView<Real>& g, const Real* paths, Real time, Real* box) {
  const GridTag<Real> wide;
  const hn::CappedTag<Real, 1> single;
  constexpr Real kFar = std::numeric_limits<Real>::infinity();
  for (std::ptrdiff_t k = 0; k < 3; ++k) {
    auto least = hn::Set(wide, kFar), most = hn::Set(wide, -kFar);
    auto least_single = hn::Set(single, kFar), most_single = hn::Set(single, -kFar);
    for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
      const GridRow<Real>& row = g.row[r];
      const Real* const x = g.motion + r * g.pitch() + k * g.line + row.column;
      const Real* const base = paths + (6 * r + k) * g.line + row.column;
      const Real* const velocity = base + 3 * g.line;
      if (row.count >= static_cast<std::ptrdiff_t>(hn::Lanes(wide)))
        widen(wide, x, base, velocity, time, row.count, least, most);
      else
        widen(single, x, base, velocity, time, row.count, least_single, most_single);
    }
    box[k] = std::min(hn::GetLane(hn::MinOfLanes(wide, least)), hn::GetLane(least_single));
    box[k + 3] = std::max(hn::GetLane(hn::MaxOfLanes(wide, most)), hn::GetLane(most_single));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
