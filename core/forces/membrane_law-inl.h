// Forces of membrane triangles in vector code.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_MEMBRANE_LAW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_MEMBRANE_LAW_INL_H
#undef WEFT_MEMBRANE_LAW_INL_H
#else
#define WEFT_MEMBRANE_LAW_INL_H
#endif

#include "core/forces/membrane.h"
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// MembraneTensor in vector registers.
template <class D>
struct MembraneLaw {
  using V = hn::Vec<D>;
  V warp, weft, coupling, shear, stretch_time, shear_time, one, half, smallest, least;

  template <class Real>
  HWY_INLINE MembraneLaw(D d, const MembraneTensor<Real>& c)
      : warp(hn::Set(d, c.warp)), weft(hn::Set(d, c.weft)), coupling(hn::Set(d, c.coupling)),
        shear(hn::Set(d, c.shear)), stretch_time(hn::Set(d, c.stretch_time)),
        shear_time(hn::Set(d, c.shear_time)), one(hn::Set(d, Real(1))), half(hn::Set(d, Real(0.5))),
        smallest(hn::Set(d, Real(kSmallestSquaredStretch))),
        least(hn::Set(d, Real(kLeastDeterminant))) {}
};

/// The gradients of MembraneTriangle. Its area is half the inverse of their determinant.
template <class V>
struct TriangleShape {
  V u1, u2, v1, v2;
};

/// Differences of positions or velocities of corners 1 and 2 from those of corner 0.
template <class V>
struct CornerDifferences {
  Triple<V> d1, d2;
};

/// The strains of a triangle.
template <class V>
struct StrainLanes {
  V u, v, shear;
};

/// A triangle's gradients w_u and w_v, their lengths, and its strains. One division serves all
/// inverses, as it takes longer than several products.
template <class D, class V = hn::Vec<D>>
struct Strained {
  Triple<V> w_u, w_v;
  V long_u, long_v, determinant;
  V inverse;  ///< 1 / (long_u long_v determinant)
  StrainLanes<V> strain;

  HWY_INLINE Strained(D tag, const MembraneLaw<D>& law, const TriangleShape<V>& shape,
                      const CornerDifferences<V>& x)
      : w_u(along(tag, x, shape.u1, shape.u2)), w_v(along(tag, x, shape.v1, shape.v2)) {
    long_u = hn::Sqrt(fused_dot(tag, w_u, w_u, law.smallest));
    long_v = hn::Sqrt(fused_dot(tag, w_v, w_v, law.smallest));
    determinant = hn::Abs(fused_minus(tag, shape.u2, shape.v1, hn::Mul(shape.u1, shape.v2)));
    inverse = hn::Div(law.one, fused(tag, determinant, hn::Mul(long_u, long_v), law.least));
    strain = {hn::Sub(long_u, law.one), hn::Sub(long_v, law.one), fused_dot(tag, w_u, w_v)};
  }

  /// Rates of the strains, times their relaxation times.
  HWY_INLINE StrainLanes<V> rates(D tag, const MembraneLaw<D>& law, const TriangleShape<V>& shape,
                                  const CornerDifferences<V>& v) const {
    const Triple<V> rate_u = along(tag, v, shape.u1, shape.u2),
                    rate_v = along(tag, v, shape.v1, shape.v2);
    const V common = hn::Mul(law.stretch_time, hn::Mul(inverse, determinant));
    return {hn::Mul(hn::Mul(common, long_v), fused_dot(tag, w_u, rate_u)),
            hn::Mul(hn::Mul(common, long_u), fused_dot(tag, w_v, rate_v)),
            hn::Mul(law.shear_time, fused_dot(tag, w_v, rate_u, fused_dot(tag, w_u, rate_v)))};
  }

  /// Pulls of corners 1 and 2 at these strains, which are minus their forces; the formulas of
  /// membrane.h.
  HWY_INLINE CornerDifferences<V> pulls(D tag, const MembraneLaw<D>& law,
                                        const TriangleShape<V>& shape,
                                        const StrainLanes<V>& e) const {
    // Half the inverse times one length is the area over the other.
    const V half = hn::Mul(law.half, inverse), per_u = hn::Mul(half, long_v);
    const V s_u = hn::Mul(per_u, fused(tag, law.warp, e.u, hn::Mul(law.coupling, e.v)));
    const V s_v =
        hn::Mul(hn::Mul(half, long_u), fused(tag, law.weft, e.v, hn::Mul(law.coupling, e.u)));
    const V t = hn::Mul(hn::Mul(per_u, long_u), hn::Mul(law.shear, e.shear));
    const Triple<V> p_u = fused(tag, w_v, t, w_u * s_u), p_v = fused(tag, w_u, t, w_v * s_v);
    return {fused(tag, p_v, shape.v1, p_u * shape.u1), fused(tag, p_v, shape.v2, p_u * shape.u2)};
  }

 private:
  static HWY_INLINE Triple<V> along(D tag, const CornerDifferences<V>& d, V first, V second) {
    return fused(tag, d.d2, second, d.d1 * first);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
