// Drift of positions without loss to rounding.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_DRIFT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_DRIFT_INL_H
#undef WEFT_DRIFT_INL_H
#else
#define WEFT_DRIFT_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// x + v dt. What rounding loses of it is added to the next drift, by Kahan's compensated sum
/// (1965): a metre from the origin a float counts in steps of 0.1 um, and in one of a hundred
/// substeps cloth of 1 mm/s moves by one or two of these.
/// @param remainder  lost before, and now [m]
template <class D, class V = hn::Vec<D>>
HWY_INLINE V drifted(D, V x, V v, V dt, V& remainder) {
  const V way = hn::Add(hn::Mul(v, dt), remainder);
  const V to = hn::Add(x, way);
  remainder = hn::Sub(way, hn::Sub(to, x));
  return to;
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
