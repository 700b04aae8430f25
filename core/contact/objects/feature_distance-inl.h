// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_FEATURE_DISTANCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_FEATURE_DISTANCE_INL_H
#undef WEFT_FEATURE_DISTANCE_INL_H
#else
#define WEFT_FEATURE_DISTANCE_INL_H
#endif

#include <bit>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include "core/contact/objects/feature_distance.h"
#include "core/math/kernels.h"
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

/// Numbers `number` to number + 2 of some features of a block.
/// @param at  number 0 of the first of them
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> load(D d, const Real* at, std::size_t number) {
  at += number * kFeatureLanes;
  return {hn::LoadU(d, at), hn::LoadU(d, at + kFeatureLanes), hn::LoadU(d, at + 2 * kFeatureLanes)};
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

/// What is found for a feature of the cloth.
template <class V>
struct Found {
  Index hits = 0;          ///< within reach, those of the features before it included
  std::size_t blocks = 0;  ///< looked at
  V beyond;                ///< bounds of what is not, squared [m^2]
};

/// Notes which features of a block are within reach.
/// @param first    block * lanes
/// @param measure  measure(lane) are the squared distances of its features from that lane on
template <class D, class Real = hn::TFromD<D>, class V = hn::Vec<D>, class Measure>
HWY_INLINE void search_block(D d, const FeatureTable<Real>& table, V reach2, Index first,
                             Measure&& measure, Found<V>& found) {
  const auto far = hn::Set(d, std::numeric_limits<Real>::max());
  ++found.blocks;
  for (std::size_t lane = 0; lane < kFeatureLanes; lane += hn::Lanes(d)) {
    const auto distance2 = measure(lane);
    const auto within = hn::Le(distance2, reach2);
    found.beyond = hn::Min(found.beyond, hn::IfThenElse(within, far, distance2));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, within, bits);
    if (bits[0] == 0) continue;
    Real squares[kFeatureLanes];
    hn::StoreU(distance2, d, squares);
    for (unsigned rest = bits[0]; rest != 0; rest &= rest - 1) {
      const int k = std::countr_zero(rest);
      table.hits[found.hits] = first + static_cast<Index>(lane) + k;
      table.hits2[found.hits++] = squares[k];
    }
  }
}

/// Squared distances of a box from those of some blocks [m^2].
/// @param box  six numbers
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> from_boxes(D d, const FeatureTable<Real>& table, const Real* box,
                                 std::size_t n) {
  auto apart2 = hn::Zero(d);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto lower = hn::LoadU(d, table.boxes + axis * table.stride + n),
               upper = hn::LoadU(d, table.boxes + (axis + 3) * table.stride + n);
    const auto above = hn::Sub(lower, hn::Set(d, box[axis + 3])),
               below = hn::Sub(hn::Set(d, box[axis]), upper);
    const auto gap = hn::Max(hn::Max(above, below), hn::Zero(d));
    apart2 = hn::Add(apart2, hn::Mul(gap, gap));
  }
  return apart2;
}

/// Searches the blocks for what is within reach of feature f of the cloth.
/// @param numbers  of a feature of the mesh
/// @param measure  measure(at) are squared distances of the features whose number 0 is at `at`
/// @param found    is added to; `beyond` is set
template <class D, class Real = hn::TFromD<D>, class V = hn::Vec<D>, class Measure>
HWY_INLINE void search(D d, const FeatureTable<Real>& table, std::size_t f, std::size_t numbers,
                       Measure&& measure, Found<V>& found) {
  const auto far = hn::Set(d, std::numeric_limits<Real>::max());
  const auto reach2 = hn::Set(d, table.reach2[f]);
  found.beyond = far;
  for (std::size_t n = 0; n < table.stride; n += hn::Lanes(d)) {
    const auto apart2 = from_boxes(d, table, table.cloth_boxes + 6 * f, n);
    const auto near = hn::Le(apart2, reach2);
    found.beyond = hn::Min(found.beyond, hn::IfThenElse(near, far, apart2));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, near, bits);
    for (unsigned rest = bits[0]; rest != 0; rest &= rest - 1) {
      const auto block =
          at_index(table.blocks[n + static_cast<std::size_t>(std::countr_zero(rest))]);
      const Real* at = table.mesh + block * numbers * kFeatureLanes;
      search_block(
          d, table, reach2, static_cast<Index>(block * kFeatureLanes),
          [&](std::size_t lane) HWY_ATTR { return measure(at + lane); }, found);
    }
  }
  table.ends[f] = found.hits;
  table.beyond2[f] = hn::GetLane(hn::MinOfLanes(d, found.beyond));
}

template <class Real>
HWY_ATTR std::size_t segments(const FeatureTable<Real>& table) {
  const hn::CappedTag<Real, kFeatureLanes> d;
  Found<hn::Vec<decltype(d)>> found;
  for (std::size_t f = 0; f < table.count; ++f) {
    const auto a = spread(d, table.cloth + 6 * f), u = spread(d, table.cloth + 6 * f + 3);
    const auto uu = dot(u, u), inverse_uu = inverse_or_zero(d, uu);
    const auto measure = [&](const Real* at) HWY_ATTR {
      return of_segments(d, a - load(d, at, 0), u, uu, inverse_uu, load(d, at, 3));
    };
    search(d, table, f, 6, measure, found);
  }
  return found.blocks;
}

template <class Real>
HWY_ATTR void complete_triangles(std::size_t blocks, Real* values) {
  const hn::CappedTag<Real, kFeatureLanes> d;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t lane = 0; lane < kFeatureLanes; lane += hn::Lanes(d)) {
      Real* at = values + b * kTriangleNumbers * kFeatureLanes + lane;
      const auto t = prepare(d, load(d, at, 3), load(d, at, 6));
      std::size_t number = 9;
      for (const auto& value : {t.normal.x, t.normal.y, t.normal.z, t.inverse_ab2, t.inverse_ac2,
                                t.inverse_bc2, t.normal2, t.inverse_normal2})
        hn::StoreU(value, d, at + number++ * kFeatureLanes);
    }
  }
}

/// Triangles that complete_triangles has prepared.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE PreparedTriangle<hn::Vec<D>> load_triangle(D d, const Real* at) {
  const auto ab = load(d, at, 3), ac = load(d, at, 6);
  const auto number = [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, at + k * kFeatureLanes); };
  return {ab,         ac,         ac - ab,    load(d, at, 9), number(12),
          number(13), number(14), number(15), number(16)};
}

template <class Real>
HWY_ATTR std::size_t points_from_triangles(const FeatureTable<Real>& table) {
  const hn::CappedTag<Real, kFeatureLanes> d;
  Found<hn::Vec<decltype(d)>> found;
  for (std::size_t f = 0; f < table.count; ++f) {
    const auto p = spread(d, table.cloth + 3 * f);
    const auto measure = [&](const Real* at) HWY_ATTR {
      return from_triangle(d, p - load(d, at, 0), load_triangle(d, at));
    };
    search(d, table, f, kTriangleNumbers, measure, found);
  }
  return found.blocks;
}

template <class Real>
HWY_ATTR std::size_t triangles_from_points(const FeatureTable<Real>& table) {
  const hn::CappedTag<Real, kFeatureLanes> d;
  Found<hn::Vec<decltype(d)>> found;
  for (std::size_t f = 0; f < table.count; ++f) {
    const Real* numbers = table.cloth + 9 * f;
    const auto a = spread(d, numbers);
    const auto triangle = prepare(d, spread(d, numbers + 3), spread(d, numbers + 6));
    const auto measure = [&](const Real* at)
                             HWY_ATTR { return from_triangle(d, load(d, at, 0) - a, triangle); };
    search(d, table, f, 3, measure, found);
  }
  return found.blocks;
}

WEFT_KERNEL(segments);
WEFT_KERNEL(points_from_triangles);
WEFT_KERNEL(triangles_from_points);
WEFT_KERNEL(complete_triangles);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
