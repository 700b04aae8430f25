// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_PAIR_SEPARATION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_PAIR_SEPARATION_INL_H
#undef WEFT_PAIR_SEPARATION_INL_H
#else
#define WEFT_PAIR_SEPARATION_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "core/contact/guard/pair_separation.h"
#include "core/math/kernels.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Numbers of where the quads of particles begin: four a particle.
HWY_INLINE auto places_of(hn::CappedTag<float, kPairPadding> d, const Index* particles) {
  const hn::RebindToSigned<decltype(d)> integers;
  return hn::ShiftLeft<2>(hn::LoadU(integers, particles));
}
HWY_INLINE auto places_of(hn::CappedTag<double, kPairPadding> d, const Index* particles) {
  const hn::RebindToSigned<decltype(d)> integers;
  const hn::Rebind<Index, decltype(d)> narrow;
  return hn::ShiftLeft<2>(hn::PromoteTo(integers, hn::LoadU(narrow, particles)));
}

/// Positions of as many particles as there are lanes.
/// @param numbers    quads
/// @param particles  their numbers
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> gather(D d, const Real* numbers, const Index* particles) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (sizeof(Real) == 4 && hn::MaxLanes(d) == 8) {
    // Whole quads, transposed: gathers of single numbers take several times as long.
    const hn::Half<D> half;
    const auto two = [&](std::size_t k) HWY_ATTR {
      return hn::Combine(d, hn::Load(half, numbers + 4 * particles[k + 4]),
                         hn::Load(half, numbers + 4 * particles[k]));
    };
    return transposed(d, two(0), two(1), two(2), two(3));
  }
#endif
  const auto places = places_of(d, particles);
  return {hn::GatherIndex(d, numbers, places), hn::GatherIndex(d, numbers + 1, places),
          hn::GatherIndex(d, numbers + 2, places)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V to_unit(D d, V value) {
  return hn::Min(hn::Max(value, hn::Zero(d)), hn::Set(d, 1));
}

/// Place of p - a = ap along a segment, 0 to 1; 0 if it has no length.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V along(D d, const Triple<V>& ap, const Triple<V>& way) {
  const V length2 = dot(way, way);
  const auto any = hn::Gt(length2, hn::Zero(d));
  return hn::IfThenElseZero(any, to_unit(d, hn::Div(dot(ap, way), length2)));
}

/// Where the other three particles of a pair lie from the first, and the closest points.
template <class V>
struct Apart {
  Triple<V> away;  ///< from the second side to the first
  V weight[4];
};

/// Closest points of edges 0 b and c d, as closest_of_segments has them.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Apart<V> edges_apart(D d, const Triple<V>& b, const Triple<V>& c, const Triple<V>& e) {
  using Real = hn::TFromD<D>;
  const Triple<V> v = e - c;
  const V uu = dot(b, b), vv = dot(v, v), uv = dot(b, v), ur = hn::Neg(dot(b, c)),
          vr = hn::Neg(dot(v, c)), one = hn::Set(d, 1);
  const V uuvv = hn::Mul(uu, vv), determinant = hn::Sub(uuvv, hn::Mul(uv, uv));
  const auto crossed = hn::Gt(determinant, hn::Mul(uuvv, hn::Set(d, Real(1e-10))));
  const V lines = hn::Div(hn::Sub(hn::Mul(uv, vr), hn::Mul(ur, vv)), determinant);
  V s = hn::IfThenElseZero(crossed, to_unit(d, lines));
  V t = along(d, b * s - c, v);
  s = along(d, c + v * t, b);
  t = along(d, b * s - c, v);
  return {b * s - (c + v * t), {hn::Sub(one, s), s, hn::Sub(t, one), hn::Neg(t)}};
}

/// Closest point of triangle b c e to the origin: in its plane if that is over its inside, else on
/// the nearest side.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Apart<V> point_apart(D d, const Triple<V>& b, const Triple<V>& c, const Triple<V>& e) {
  using Real = hn::TFromD<D>;
  const Triple<V> bc = c - b, be = e - b, ce = e - c, zero = b - b;
  const V one = hn::Set(d, 1), none = hn::Zero(d);
  const Triple<V> from_b = zero - b, from_c = zero - c;
  const V t1 = along(d, from_b, bc), t2 = along(d, from_b, be), t3 = along(d, from_c, ce);
  const Triple<V> p1 = b + bc * t1, p2 = b + be * t2, p3 = c + ce * t3;
  const V d1 = dot(p1, p1), d2 = dot(p2, p2), d3 = dot(p3, p3);
  Triple<V> point = p1;
  V wb = hn::Sub(one, t1), wc = t1, we = none, nearest = d1;
  const auto second = hn::Lt(d2, nearest);
  point = select(second, p2, point);
  nearest = hn::IfThenElse(second, d2, nearest);
  wb = hn::IfThenElse(second, hn::Sub(one, t2), wb);
  wc = hn::IfThenElseZero(hn::Not(second), wc);
  we = hn::IfThenElse(second, t2, we);
  const auto third = hn::Lt(d3, nearest);
  point = select(third, p3, point);
  wb = hn::IfThenElseZero(hn::Not(third), wb);
  wc = hn::IfThenElse(third, hn::Sub(one, t3), wc);
  we = hn::IfThenElse(third, t3, we);
  // Thin ones lose the sign of their weights to rounding; their sides are as near.
  const Triple<V> normal = cross(bc, be);
  const V normal2 = dot(normal, normal);
  constexpr Real kRounding = 16 * std::numeric_limits<Real>::epsilon();
  const V thin = hn::Mul(hn::Mul(dot(bc, bc), dot(be, be)), hn::Set(d, kRounding * kRounding));
  const V ic = hn::Div(dot(cross(from_b, be), normal), normal2),
          ie = hn::Div(dot(cross(bc, from_b), normal), normal2), ib = hn::Sub(hn::Sub(one, ic), ie);
  const auto inside = hn::And(hn::And(hn::Gt(normal2, thin), hn::Gt(ib, none)),
                              hn::And(hn::Gt(ic, none), hn::Gt(ie, none)));
  point = select(inside, b + bc * ic + be * ie, point);
  wb = hn::IfThenElse(inside, ib, wb);
  wc = hn::IfThenElse(inside, ic, wc);
  we = hn::IfThenElse(inside, ie, we);
  return {zero - point, {one, hn::Neg(wb), hn::Neg(wc), hn::Neg(we)}};
}

/// min over the first side minus max over the second of n.x, as gap_along.
template <class V>
HWY_INLINE V gap_of(PairKind kind, const Triple<V>& b, const Triple<V>& c, const Triple<V>& e,
                    const Triple<V>& n, V zero) {
  const V beyond = hn::Max(dot(n, c), dot(n, e)), second = dot(n, b);
  if (kind == PairKind::vertex_triangle) return hn::Neg(hn::Max(second, beyond));
  return hn::Sub(hn::Min(zero, second), beyond);
}

template <class Real>
HWY_ATTR void separate(const Real* x, const Real* end, std::size_t first, std::size_t last,
                       PairColumns<Real>& pairs) {
  const hn::CappedTag<Real, kPairPadding> d;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d);
  for (std::size_t k = first; k < last; k += hn::Lanes(d)) {
    const auto at = [&](const Real* quads, std::size_t side)
                        HWY_ATTR { return gather(d, quads, pairs.particle[side].data() + k); };
    const Triple<V> a = at(x, 0), b = at(x, 1) - a, c = at(x, 2) - a, e = at(x, 3) - a;
    const Apart<V> apart =
        pairs.kind == PairKind::vertex_triangle ? point_apart(d, b, c, e) : edges_apart(d, b, c, e);
    const V distance = hn::Sqrt(dot(apart.away, apart.away));
    const auto clear = hn::Gt(distance, hn::Set(d, Real(1e-12)));
    const V per_distance = hn::IfThenElseZero(clear, hn::Div(hn::Set(d, 1), distance));
    const Triple<V> n = apart.away * per_distance;
    const V none = hn::Set(d, -std::numeric_limits<Real>::infinity());
    hn::StoreU(hn::IfThenElse(clear, gap_of(pairs.kind, b, c, e, n, zero), none), d,
               pairs.gap.data() + k);
    if (end != x) {
      const Triple<V> ea = at(end, 0);
      hn::StoreU(gap_of(pairs.kind, at(end, 1) - ea, at(end, 2) - ea, at(end, 3) - ea, n, zero), d,
                 pairs.end_gap.data() + k);
    }
    hn::StoreU(n.x, d, pairs.normal[0].data() + k);
    hn::StoreU(n.y, d, pairs.normal[1].data() + k);
    hn::StoreU(n.z, d, pairs.normal[2].data() + k);
    for (std::size_t w = 0; w < 4; ++w) hn::StoreU(apart.weight[w], d, pairs.weight[w].data() + k);
  }
}

WEFT_KERNEL(separate);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
