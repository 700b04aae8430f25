// Force of springs in vector code.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_SPRING_LAW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SPRING_LAW_INL_H
#undef WEFT_SPRING_LAW_INL_H
#else
#define WEFT_SPRING_LAW_INL_H
#endif

#include "core/forces/spring.h"
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One kind of spring: rest length and dashpot per stiffness.
template <class D>
struct SpringLaw {
  hn::Vec<D> one, rest_length, damping, smallest;
};

/// Force on the start of springs, as a factor of the vector d from start to end; the formula of
/// spring.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V spring(D tag, const SpringLaw<D>& law, V stiffness, const Triple<V>& d,
                    const Triple<V>& dv) {
  const V per_l = inverse_root(tag, fused_dot(tag, d, d, law.smallest));
  const V elastic = fused_minus(tag, law.rest_length, per_l, law.one);
  const V rate = hn::Mul(fused_dot(tag, d, dv), hn::Mul(per_l, per_l));
  return hn::Mul(stiffness, fused(tag, law.damping, rate, elastic));
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
