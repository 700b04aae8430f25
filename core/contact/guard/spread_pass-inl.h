// Whether a rectangle is stretched out, for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_SPREAD_PASS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SPREAD_PASS_INL_H
#undef WEFT_SPREAD_PASS_INL_H
#else
#define WEFT_SPREAD_PASS_INL_H
#endif

#include <algorithm>
#include <cstdint>

#include <hwy/highway.h>

#include "core/contact/guard/spread_pass.h"
#include "core/math/kernels.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Two components of the gradient in the plane.
template <class V>
struct InPlane {
  V u, v;
};

/// The gradient along sides of one direction.
/// @param of  0: along rows; 2: along columns
template <class D, class Real = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE InPlane<V> in_plane(D d, const SpreadPass<Real>& p, const Triple<V>& side,
                               std::size_t of) {
  const auto sum = [&](std::size_t axis) HWY_ATTR {
    const V x = hn::Mul(side.x, hn::Set(d, p.axes[0][axis])),
            y = hn::Mul(side.y, hn::Set(d, p.axes[1][axis])),
            z = hn::Mul(side.z, hn::Set(d, p.axes[2][axis]));
    return hn::Add(hn::Add(x, y), z);
  };
  return {sum(of), sum(of + 1)};
}

/// Of each triangle whether the symmetric part of its gradient has no eigenvalue below `least`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> exceeds(D d, V least, const InPlane<V>& along_u, const InPlane<V>& along_v) {
  const V a = hn::Sub(along_u.u, least), b = hn::Sub(along_v.v, least);
  const V off = hn::Mul(hn::Add(along_u.v, along_v.u), hn::Set(d, hn::TFromD<D>(0.5)));
  const auto positive = hn::And(hn::Gt(a, hn::Zero(d)), hn::Gt(b, hn::Zero(d)));
  return hn::And(positive, hn::Gt(hn::Mul(a, b), hn::Mul(off, off)));
}

/// Calls visit(r, mask) for all rows of as many columns as a vector has, from column c on, with
/// the cells whose triangles are both stretched out, until one call says no.
/// @return whether none did
template <class D, class Visit, class Real = hn::TFromD<D>>
HWY_INLINE bool visit_rows(D d, const SpreadPass<Real>& p, std::ptrdiff_t c, Visit&& visit) {
  using V = hn::Vec<D>;
  const auto at = [&](std::ptrdiff_t row, std::ptrdiff_t column) HWY_ATTR {
    Triple<V> x;
    V none;
    hn::LoadInterleaved4(d, reinterpret_cast<const Real*>(p.x + row * p.particles + column), x.x,
                         x.y, x.z, none);
    return x;
  };
  const V least = hn::Set(d, p.least);
  Triple<V> left = at(0, c), right = at(0, c + 1);
  InPlane<V> first_u = in_plane(d, p, right - left, 0);
  for (std::ptrdiff_t r = 0; r < p.rows; ++r) {
    const Triple<V> next_left = at(r + 1, c), next_right = at(r + 1, c + 1);
    const InPlane<V> last_u = in_plane(d, p, next_right - next_left, 0),
                     first_v = in_plane(d, p, next_left - left, 2),
                     last_v = in_plane(d, p, next_right - right, 2);
    const auto falls = hn::Gt(hn::LoadU(d, p.falls + r * p.cells + c), hn::Zero(d));
    const auto pick = [&](const InPlane<V>& yes, const InPlane<V>& no) HWY_ATTR {
      return InPlane<V>{hn::IfThenElse(falls, yes.u, no.u), hn::IfThenElse(falls, yes.v, no.v)};
    };
    const auto both = hn::And(exceeds(d, least, first_u, pick(last_v, first_v)),
                              exceeds(d, least, last_u, pick(first_v, last_v)));
    if (!visit(r, both)) return false;
    left = next_left;
    right = next_right;
    first_u = last_u;
  }
  return true;
}

/// Calls visit(d, c) for all columns, as many at a time as a vector has. The last vector overlaps
/// the one before it.
/// @return whether no call said no
template <class Real, class Visit>
HWY_INLINE bool visit_columns(const SpreadPass<Real>& p, Visit&& visit) {
  const auto all = [&](auto d) HWY_ATTR {
    const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
    for (std::ptrdiff_t c = 0; c < p.columns; c += lanes) {
      if (!visit(d, std::min(c, p.columns - lanes))) return false;
    }
    return true;
  };
  const hn::CappedTag<Real, 8> eight;
  const hn::CappedTag<Real, 4> four;
  if (p.columns >= static_cast<int>(hn::Lanes(eight))) return all(eight);
  if (p.columns >= static_cast<int>(hn::Lanes(four))) return all(four);
  return all(hn::CappedTag<Real, 1>());
}

template <class Real>
HWY_ATTR bool spread(const SpreadPass<Real>& p) {
  return visit_columns(p, [&](auto d, std::ptrdiff_t c) HWY_ATTR {
    return visit_rows(d, p, c,
                      [&](std::ptrdiff_t, auto mask) HWY_ATTR { return hn::AllTrue(d, mask); });
  });
}

template <class Real>
HWY_ATTR std::uint64_t spread_ones(const SpreadPass<Real>& p) {
  std::uint64_t found = 0;
  visit_columns(p, [&](auto d, std::ptrdiff_t c) HWY_ATTR {
    return visit_rows(d, p, c, [&](std::ptrdiff_t r, auto mask) HWY_ATTR {
      std::uint8_t byte[8] = {};
      hn::StoreMaskBits(d, mask, byte);
      found |= static_cast<std::uint64_t>(byte[0]) << (kMostSpreadCells * r + c);
      return true;
    });
  });
  return found;
}

WEFT_KERNEL(spread);
WEFT_KERNEL(spread_ones);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
