// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_LONE_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_LONE_ROWS_INL_H
#undef WEFT_LONE_ROWS_INL_H
#else
#define WEFT_LONE_ROWS_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "core/contact/objects/lone_rows.h"
#include "core/math/kernels.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// In the order in which the rows that are solved one by one have it, so that the bits are theirs.
template <class V>
HWY_INLINE V dot_as_single(const Triple<V>& a, const Triple<V>& b) {
  return hn::Add(hn::Mul(a.x, b.x), hn::Add(hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)));
}

/// Calls body(d, block, lane, particle) for the rows that one vector holds, by their first ones.
template <class Real, class Body>
HWY_INLINE void for_each_vector(std::span<LoneBlock<Real>> blocks, Body&& body) {
  const hn::CappedTag<Real, kLoneLanes> d;
  for (LoneBlock<Real>& block : blocks) {
    for (std::size_t k = 0; k < kLoneLanes; k += hn::Lanes(d))
      body(d, block, k, at_index(block.first) + k);
  }
}

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> normals(D d, const LoneBlock<Real>& rows, std::size_t k) {
  return {hn::LoadU(d, rows.normal[0] + k), hn::LoadU(d, rows.normal[1] + k),
          hn::LoadU(d, rows.normal[2] + k)};
}

/// Whether rows are nearer to touching than their particles go.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> busy(D d, const LoneBlock<Real>& rows, const LonePass<Real>& pass,
                            std::size_t k, std::size_t i) {
  return hn::Not(hn::Lt(hn::LoadU(d, pass.travel2 + i), hn::LoadU(d, rows.touch2 + k)));
}

/// What a response does to velocities: see sweep_rows in row_response.h.
/// @param push  that each row lacks of its normal velocity [m/s]; vn  which it has [m/s]
template <class V, class M>
HWY_INLINE Triple<V> velocity_change(const Triple<V>& n, const Triple<V>& v, V vn, V push,
                                     V friction, M rubs) {
  const auto change = n * push, slip = v - n * vn;
  const V speed = hn::Sqrt(dot_as_single(slip, slip)), most = hn::Mul(friction, push);
  const auto stopped = select(hn::Gt(speed, most), slip * hn::Div(most, speed), slip);
  return select(rubs, change - stopped, change);
}

/// Sets the normal velocity that each row must reach, and moves out what lacks thickness; what is
/// pushed still lacks some then, and has no room.
/// @return which are pushed
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> aim(D d, LoneBlock<Real>& rows, const LonePass<Real>& pass, std::size_t k,
                           hn::Mask<D> acts, const Triple<hn::Vec<D>>& n, Triple<hn::Vec<D>>& x) {
  const auto gap = hn::Sub(dot_as_single(n, x), hn::LoadU(d, rows.offset + k));
  const auto thickness = hn::LoadU(d, rows.thickness + k), slack = hn::Set(d, pass.slack);
  const auto over = hn::Sub(hn::Sub(gap, thickness), slack), zero = hn::Zero(d);
  const auto room = hn::IfThenElse(hn::Gt(over, zero), over, zero);
  const auto any = hn::Set(d, -std::numeric_limits<Real>::infinity());
  const auto least = hn::Div(hn::Neg(room), hn::Set(d, pass.dt));
  hn::StoreU(hn::IfThenElse(acts, least, any), d, rows.least_speed + k);
  if (pass.push_part == 0) return hn::Gt(zero, zero);
  const auto lack = hn::Sub(thickness, gap);
  const auto pushed = hn::And(acts, hn::Gt(lack, slack));
  if (hn::AllFalse(d, pushed)) return pushed;
  const auto part = hn::Mul(lack, hn::Set(d, pass.push_part));
  const auto most = hn::IfThenElse(hn::Gt(lack, thickness), hn::Set(d, pass.lead_most),
                                   hn::Set(d, pass.push_most));
  const auto step = hn::IfThenElse(hn::Lt(most, part), most, part);
  x = select(pushed, x + n * step, x);
  return pushed;
}

/// One response of rows whose velocities are loaded. @return which have responded
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> respond(D d, const LoneBlock<Real>& rows, const LonePass<Real>& pass,
                               std::size_t k, std::size_t i, const Triple<hn::Vec<D>>& n,
                               Triple<hn::Vec<D>>& v, LoneResponse<Real>& result) {
  const auto zero = hn::Zero(d), vn = dot_as_single(n, v);
  const auto push = hn::Sub(hn::LoadU(d, rows.least_speed + k), vn);
  const auto responds = hn::Gt(push, zero);
  if (hn::AllFalse(d, responds)) return responds;
  const Real most = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(responds, push)));
  result.largest = most > result.largest ? most : result.largest;
  const auto friction = hn::LoadU(d, rows.friction + k);
  const auto rubs = hn::And(responds, hn::Gt(friction, zero));
  result.friction_evaluations += hn::CountTrue(d, rubs);
  const auto before = v;
  v = select(responds, v + velocity_change(n, v, vn, push, friction, rubs), v);
  if (pass.given) {
    // What velocities have got, rounded as they are, is what others tell.
    Real* const given = pass.given + 3 * i;
    store_particles(d, load_particles(d, given) + (v - before), given);
  }
  return responds;
}

/// Measures the ways of those anew that have been moved or pushed.
/// @return whether all of them end within their reach
template <class D, class M, class Real = hn::TFromD<D>>
HWY_INLINE bool measure(D d, const LonePass<Real>& pass, std::size_t i, M moved,
                        const Triple<hn::Vec<D>>& x, const Triple<hn::Vec<D>>& v) {
  const auto way = x - load_particles(d, pass.from + 3 * i);
  const auto end = way + v * hn::Set(d, pass.dt);
  const auto now2 = dot_as_single(way, way), end2 = dot_as_single(end, end);
  const auto longest2 = hn::IfThenElse(hn::Lt(now2, end2), end2, now2);
  const auto known = hn::LoadU(d, pass.travel2 + i), reach = hn::LoadU(d, pass.reach + i);
  hn::StoreU(hn::IfThenElse(moved, longest2, known), d, pass.travel2 + i);
  return hn::AllTrue(d, hn::Or(hn::Le(end2, hn::Mul(reach, reach)), hn::Not(moved)));
}

template <class Real>
HWY_ATTR LoneResponse<Real> step(std::span<LoneBlock<Real>> blocks, const LonePass<Real>& pass) {
  LoneResponse<Real> result;
  for_each_vector(
      blocks, [&](auto d, LoneBlock<Real>& rows, std::size_t k, std::size_t i) HWY_ATTR {
        const auto acts = busy(d, rows, pass, k, i);
        if (hn::AllFalse(d, acts)) {
          const auto any = hn::Set(d, -std::numeric_limits<Real>::infinity());
          return hn::StoreU(any, d, rows.least_speed + k);
        }
        const auto n = normals(d, rows, k);
        auto x = load_particles(d, pass.x + 3 * i), v = load_particles(d, pass.v + 3 * i);
        const auto pushed = aim(d, rows, pass, k, acts, n, x);
        const auto responds = respond(d, rows, pass, k, i, n, v, result);
        const auto moved = hn::Or(pushed, responds);
        if (hn::AllFalse(d, moved)) return;
        if (!hn::AllFalse(d, pushed)) store_particles(d, x, pass.x + 3 * i);
        store_particles(d, v, pass.v + 3 * i);
        result.within &= measure(d, pass, i, moved, x, v);
      });
  return result;
}

template <class Real>
HWY_ATTR LoneResponse<Real> sweep(std::span<LoneBlock<Real>> blocks, const LonePass<Real>& pass) {
  LoneResponse<Real> result;
  for_each_vector(blocks,
                  [&](auto d, LoneBlock<Real>& rows, std::size_t k, std::size_t i) HWY_ATTR {
                    auto v = load_particles(d, pass.v + 3 * i);
                    const auto n = normals(d, rows, k);
                    const auto responds = respond(d, rows, pass, k, i, n, v, result);
                    if (!hn::AllFalse(d, responds)) store_particles(d, v, pass.v + 3 * i);
                  });
  return result;
}

/// @return number of the first block, not before `from`, with a particle that may cross its plane;
/// blocks.size() if there is none
template <class Real>
HWY_ATTR std::size_t next_crossing(std::span<const LoneBlock<Real>> blocks, const Real* travel2,
                                   std::size_t from) {
  const hn::CappedTag<Real, kLoneLanes> d;
  for (std::size_t b = from; b < blocks.size(); ++b) {
    for (std::size_t k = 0; k < kLoneLanes; k += hn::Lanes(d)) {
      const auto way2 = hn::LoadU(d, travel2 + blocks[b].first + k);
      if (!hn::AllTrue(d, hn::Lt(way2, hn::LoadU(d, blocks[b].cross2 + k)))) return b;
    }
  }
  return blocks.size();
}

WEFT_KERNEL(step);
WEFT_KERNEL(sweep);
WEFT_KERNEL(next_crossing);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
