// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_FEATURE_DISTANCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_FEATURE_DISTANCE_INL_H
#undef WEFT_FEATURE_DISTANCE_INL_H
#else
#define WEFT_FEATURE_DISTANCE_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "core/contact/objects/feature_distance.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// 1 / value, and 0 for what has no size.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse_or_zero(D d, V value) {
  const auto zero = hn::Zero(d);
  return hn::IfThenElseZero(hn::Gt(value, zero), hn::Div(hn::Set(d, 1), value));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V clamp_to_unit(D d, V value) {
  return hn::Min(hn::Max(value, hn::Zero(d)), hn::Set(d, 1));
}

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> spread(D d, const Real* numbers) {
  return {hn::Set(d, numbers[0]), hn::Set(d, numbers[1]), hn::Set(d, numbers[2])};
}

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> load(D d, const FeatureTable<Real>& table, std::size_t number,
                                   std::size_t n) {
  const Real* at = table.mesh + number * table.stride + n;
  return {hn::LoadU(d, at), hn::LoadU(d, at + table.stride), hn::LoadU(d, at + 2 * table.stride)};
}

/// Squared distance of point p - a = ap from the segment a to a + way.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V from_segment(D d, const Triple<V>& ap, const Triple<V>& way, V inverse_length2) {
  const V t = clamp_to_unit(d, hn::Mul(dot(ap, way), inverse_length2));
  const Triple<V> apart = ap - way * t;
  return dot(apart, apart);
}

/// What the distance from a triangle needs of the triangle alone.
template <class V>
struct PreparedTriangle {
  Triple<V> ab, ac, bc, normal;
  V inverse_ab2, inverse_ac2, inverse_bc2, normal2, inverse_normal2;
};

/// @param ab,ac  ways from a corner to the other two
template <class D, class V = hn::Vec<D>, class Real = hn::TFromD<D>>
HWY_INLINE PreparedTriangle<V> prepare(D d, const Triple<V>& ab, const Triple<V>& ac) {
  const Triple<V> bc = ac - ab, normal = cross(ab, ac);
  const V ab2 = dot(ab, ab), ac2 = dot(ac, ac), doubled_area2 = dot(normal, normal);
  // Thinner ones lose the sign of their weights to rounding; their sides are as near.
  constexpr Real kRounding = 16 * std::numeric_limits<Real>::epsilon();
  const V thin = hn::Mul(hn::Mul(ab2, ac2), hn::Set(d, kRounding * kRounding));
  const V normal2 = hn::IfThenElseZero(hn::Gt(doubled_area2, thin), doubled_area2);
  return {ab,
          ac,
          bc,
          normal,
          inverse_or_zero(d, ab2),
          inverse_or_zero(d, ac2),
          inverse_or_zero(d, dot(bc, bc)),
          normal2,
          inverse_or_zero(d, normal2)};
}

/// Squared distance of a point from a triangle: from its plane if the point is over its inside,
/// else from the nearest of its sides. One without area has sides alone.
/// @param ap  way from the corner to the point
template <class D, class V = hn::Vec<D>>
HWY_INLINE V from_triangle(D d, const Triple<V>& ap, const PreparedTriangle<V>& t) {
  const V sides = hn::Min(
      hn::Min(from_segment(d, ap, t.ab, t.inverse_ab2), from_segment(d, ap, t.ac, t.inverse_ac2)),
      from_segment(d, ap - t.ab, t.bc, t.inverse_bc2));
  const V weight_b = dot(cross(ap, t.ac), t.normal), weight_c = dot(cross(t.ab, ap), t.normal);
  const V weight_a = hn::Sub(hn::Sub(t.normal2, weight_b), weight_c);
  const V height = dot(ap, t.normal), zero = hn::Zero(d);
  const auto over = hn::And(hn::And(hn::Gt(weight_a, zero), hn::Gt(weight_b, zero)),
                            hn::And(hn::Gt(weight_c, zero), hn::Gt(t.normal2, zero)));
  // The height over a thin one is rounding for the most part; no side is nearer than its inside.
  const V height2 = hn::Mul(hn::Mul(height, height), t.inverse_normal2);
  return hn::IfThenElse(over, hn::Min(height2, sides), sides);
}

/// Squared distance of segments a + s u and c + t v, from r = a - c: the best s of the lines, the
/// best t for it, and the best s for that (Ericson 2005, section 5.1.9).
template <class D, class V = hn::Vec<D>, class Real = hn::TFromD<D>>
HWY_INLINE V of_segments(D d, const Triple<V>& r, const Triple<V>& u, V uu, V inverse_uu,
                         const Triple<V>& v) {
  const V vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  const V uuvv = hn::Mul(uu, vv), determinant = hn::Sub(uuvv, hn::Mul(uv, uv));
  const auto apart = hn::Gt(determinant, hn::Mul(uuvv, hn::Set(d, Real(1e-10))));
  const V free = hn::Div(hn::Sub(hn::Mul(uv, vr), hn::Mul(ur, vv)), determinant);
  const V first = hn::IfThenElseZero(apart, clamp_to_unit(d, free));
  const V t = clamp_to_unit(d, hn::Mul(hn::Add(vr, hn::Mul(uv, first)), inverse_or_zero(d, vv)));
  const V s = clamp_to_unit(d, hn::Mul(hn::Sub(hn::Mul(uv, t), ur), inverse_uu));
  const Triple<V> way = r - (v * t - u * s);
  return dot(way, way);
}

/// Fills the row of the cloth's feature f with measure(n), the squared distances of the mesh's
/// features from number n on.
template <class D, class Real = hn::TFromD<D>, class Measure>
HWY_INLINE void fill_row(D d, const FeatureTable<Real>& table, std::size_t f, Measure&& measure) {
  const auto far = hn::Set(d, std::numeric_limits<Real>::max());
  const auto reach2 = hn::Set(d, table.reach2[f]);
  auto nearest = far, beyond = far;
  for (std::size_t n = 0; n < table.stride; n += hn::Lanes(d)) {
    const auto distance2 = measure(n);
    hn::StoreU(distance2, d, table.distance2 + f * table.stride + n);
    nearest = hn::Min(nearest, distance2);
    beyond = hn::Min(beyond, hn::IfThenElse(hn::Le(distance2, reach2), far, distance2));
  }
  table.nearest2[f] = hn::GetLane(hn::MinOfLanes(d, nearest));
  table.beyond2[f] = hn::GetLane(hn::MinOfLanes(d, beyond));
}

template <class Real>
HWY_INLINE void segments(const FeatureTable<Real>& table) {
  const hn::CappedTag<Real, kFeaturePadding> d;
  for (std::size_t f = 0; f < table.count; ++f) {
    const auto a = spread(d, table.cloth + 6 * f), u = spread(d, table.cloth + 6 * f + 3);
    const auto uu = dot(u, u), inverse_uu = inverse_or_zero(d, uu);
    fill_row(d, table, f, [&](std::size_t n) HWY_ATTR {
      return of_segments(d, a - load(d, table, 0, n), u, uu, inverse_uu, load(d, table, 3, n));
    });
  }
}

template <class Real>
HWY_INLINE void complete_triangles(std::size_t stride, Real* columns) {
  const hn::CappedTag<Real, kFeaturePadding> d;
  FeatureTable<Real> table;
  table.stride = stride;
  table.mesh = columns;
  for (std::size_t n = 0; n < stride; n += hn::Lanes(d)) {
    const auto t = prepare(d, load(d, table, 3, n), load(d, table, 6, n));
    std::size_t number = 9;
    for (const auto& column : {t.normal.x, t.normal.y, t.normal.z, t.inverse_ab2, t.inverse_ac2,
                               t.inverse_bc2, t.normal2, t.inverse_normal2})
      hn::StoreU(column, d, columns + number++ * stride + n);
  }
}

/// Triangles that complete_triangles has prepared.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE PreparedTriangle<hn::Vec<D>> load_triangle(D d, const FeatureTable<Real>& table,
                                                      std::size_t n) {
  const auto ab = load(d, table, 3, n), ac = load(d, table, 6, n);
  const auto column = [&](std::size_t k)
                          HWY_ATTR { return hn::LoadU(d, table.mesh + k * table.stride + n); };
  return {ab,         ac,         ac - ab,   load(d, table, 9, n), column(12), column(13),
          column(14), column(15), column(16)};
}

template <class Real>
HWY_INLINE void points_from_triangles(const FeatureTable<Real>& table) {
  const hn::CappedTag<Real, kFeaturePadding> d;
  for (std::size_t f = 0; f < table.count; ++f) {
    const auto p = spread(d, table.cloth + 3 * f);
    fill_row(d, table, f, [&](std::size_t n) HWY_ATTR {
      return from_triangle(d, p - load(d, table, 0, n), load_triangle(d, table, n));
    });
  }
}

template <class Real>
HWY_INLINE void triangles_from_points(const FeatureTable<Real>& table) {
  const hn::CappedTag<Real, kFeaturePadding> d;
  for (std::size_t f = 0; f < table.count; ++f) {
    const Real* numbers = table.cloth + 9 * f;
    const auto a = spread(d, numbers);
    const auto triangle = prepare(d, spread(d, numbers + 3), spread(d, numbers + 6));
    fill_row(d, table, f, [&](std::size_t n) HWY_ATTR {
      return from_triangle(d, load(d, table, 0, n) - a, triangle);
    });
  }
}

#define WEFT_KERNEL(name)                                       \
  HWY_ATTR void name##_f32(const FeatureTable<float>& table) {  \
    name(table);                                                \
  }                                                             \
  HWY_ATTR void name##_f64(const FeatureTable<double>& table) { \
    name(table);                                                \
  }
WEFT_KERNEL(segments)
WEFT_KERNEL(points_from_triangles)
WEFT_KERNEL(triangles_from_points)
#undef WEFT_KERNEL

HWY_ATTR void complete_triangles_f32(std::size_t stride, float* columns) {
  complete_triangles(stride, columns);
}
HWY_ATTR void complete_triangles_f64(std::size_t stride, double* columns) {
  complete_triangles(stride, columns);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
