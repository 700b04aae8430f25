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

/// Calls body(d, row, particle) for stretches of rows whose particles follow each other, and for
/// the rows left one by one.
template <class Real, class Body>
HWY_INLINE void for_each_run(const LoneView<Real>& rows, Body&& body) {
  const hn::CappedTag<Real, 8> wide;
  const hn::CappedTag<Real, 1> single;
  const std::size_t lanes = hn::Lanes(wide);
  for (std::size_t k = 0; k < rows.count;) {
    const auto first = static_cast<std::size_t>(rows.particle[k]);
    if (k + lanes <= rows.count &&
        static_cast<std::size_t>(rows.particle[k + lanes - 1]) == first + lanes - 1) {
      body(wide, k, first);
      k += lanes;
    } else {
      body(single, k, first);
      ++k;
    }
  }
}

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> normals(D d, const LoneView<Real>& rows, std::size_t k) {
  return {hn::LoadU(d, rows.normal[0] + k), hn::LoadU(d, rows.normal[1] + k),
          hn::LoadU(d, rows.normal[2] + k)};
}

/// Whether rows are nearer to touching than their particles go.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> busy(D d, const LoneView<Real>& rows, const LonePass<Real>& pass,
                            std::size_t k, std::size_t i) {
  return hn::Not(hn::Lt(hn::LoadU(d, pass.travel2 + i), hn::LoadU(d, rows.touch2 + k)));
}

/// @tparam Pushes  push out first; who is pushed still lacks thickness then, and has no room
template <bool Pushes, class Real>
HWY_INLINE void aim(const LoneView<Real>& rows, const LonePass<Real>& pass) {
  for_each_run(rows, [&](auto d, std::size_t k, std::size_t i) HWY_ATTR {
    const auto n = normals(d, rows, k), x = load_particles(d, pass.x + 3 * i);
    const auto gap = hn::Sub(dot_as_single(n, x), hn::LoadU(d, rows.offset + k));
    const auto thickness = hn::LoadU(d, rows.thickness + k), slack = hn::Set(d, pass.slack);
    const auto acts = busy(d, rows, pass, k, i);
    const auto over = hn::Sub(hn::Sub(gap, thickness), slack), zero = hn::Zero(d);
    const auto room = hn::IfThenElse(hn::Gt(over, zero), over, zero);
    const auto any = hn::Set(d, -std::numeric_limits<Real>::infinity());
    const auto least = hn::Div(hn::Neg(room), hn::Set(d, pass.dt));
    hn::StoreU(hn::IfThenElse(acts, least, any), d, rows.least_speed + k);
    if constexpr (!Pushes) return;
    const auto lack = hn::Sub(thickness, gap);
    const auto pushed = hn::And(acts, hn::Gt(lack, slack));
    if (hn::AllFalse(d, pushed)) return;
    const auto part = hn::Mul(lack, hn::Set(d, pass.push_part)), most = hn::Set(d, pass.push_most);
    const auto step = hn::IfThenElse(hn::Lt(most, part), most, part);
    store_particles(d, select(pushed, x + n * step, x), pass.x + 3 * i);
    const auto one = hn::Set(d, Real(1));
    hn::StoreU(hn::IfThenElse(pushed, one, hn::LoadU(d, rows.pushed + k)), d, rows.pushed + k);
  });
}

template <class Real>
HWY_INLINE Real sweep(const LoneView<Real>& rows, const LonePass<Real>& pass,
                      std::uint64_t& evaluations) {
  Real largest = 0;
  for_each_run(rows, [&](auto d, std::size_t k, std::size_t i) HWY_ATTR {
    const auto n = normals(d, rows, k), v = load_particles(d, pass.v + 3 * i);
    const auto zero = hn::Zero(d), vn = dot_as_single(n, v);
    const auto push = hn::Sub(hn::LoadU(d, rows.least_speed + k), vn);
    const auto pushed = hn::Gt(push, zero);
    if (hn::AllFalse(d, pushed)) return;
    const Real most_push = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(pushed, push)));
    largest = most_push > largest ? most_push : largest;
    auto change = n * push;
    const auto friction = hn::LoadU(d, rows.friction + k);
    const auto rubs = hn::And(pushed, hn::Gt(friction, zero));
    evaluations += hn::CountTrue(d, rubs);
    const auto slip = v - n * vn;
    const auto speed = hn::Sqrt(dot_as_single(slip, slip)), most = hn::Mul(friction, push);
    const auto stopped = select(hn::Gt(speed, most), slip * hn::Div(most, speed), slip);
    change = select(rubs, change - stopped, change);
    store_particles(d, select(pushed, v + change, v), pass.v + 3 * i);
    const auto one = hn::Set(d, Real(1));
    hn::StoreU(hn::IfThenElse(pushed, one, hn::LoadU(d, rows.pushed + k)), d, rows.pushed + k);
  });
  return largest;
}

template <class Real>
HWY_INLINE bool measure_pushed(const LoneView<Real>& rows, const LonePass<Real>& pass) {
  bool within = true;
  for_each_run(rows, [&](auto d, std::size_t k, std::size_t i) HWY_ATTR {
    const auto pushed = hn::Gt(hn::LoadU(d, rows.pushed + k), hn::Zero(d));
    if (hn::AllFalse(d, pushed)) return;
    const auto way = load_particles(d, pass.x + 3 * i) - load_particles(d, pass.from + 3 * i);
    const auto end = way + load_particles(d, pass.v + 3 * i) * hn::Set(d, pass.dt);
    const auto now2 = dot_as_single(way, way), end2 = dot_as_single(end, end);
    const auto longest2 = hn::IfThenElse(hn::Lt(now2, end2), end2, now2);
    const auto known = hn::LoadU(d, pass.travel2 + i), reach = hn::LoadU(d, pass.reach + i);
    hn::StoreU(hn::IfThenElse(pushed, longest2, known), d, pass.travel2 + i);
    const auto near = hn::Le(end2, hn::Mul(reach, reach));
    within &= hn::AllTrue(d, hn::Or(near, hn::Not(pushed)));
  });
  return within;
}

/// @return count if there is none
template <class Real>
HWY_INLINE std::size_t next_crossing(const LoneView<Real>& rows, const Real* travel2,
                                     std::size_t from) {
  const hn::CappedTag<Real, 8> wide;
  const std::size_t lanes = hn::Lanes(wide);
  for (std::size_t k = from; k < rows.count;) {
    const auto first = static_cast<std::size_t>(rows.particle[k]);
    if (k + lanes <= rows.count &&
        static_cast<std::size_t>(rows.particle[k + lanes - 1]) == first + lanes - 1 &&
        hn::AllTrue(wide,
                    hn::Lt(hn::LoadU(wide, travel2 + first), hn::LoadU(wide, rows.cross2 + k)))) {
      k += lanes;
      continue;
    }
    if (!(travel2[first] < rows.cross2[k])) return k;
    ++k;
  }
  return rows.count;
}

#define WEFT_LONE_KERNELS(Real, Kind)                                                           \
  HWY_ATTR void push_and_aim_##Kind(const LoneView<Real>& rows, const LonePass<Real>& pass) {   \
    aim<true>(rows, pass);                                                                      \
  }                                                                                             \
  HWY_ATTR void aim_##Kind(const LoneView<Real>& rows, const LonePass<Real>& pass) {            \
    aim<false>(rows, pass);                                                                     \
  }                                                                                             \
  HWY_ATTR Real sweep_##Kind(const LoneView<Real>& rows, const LonePass<Real>& pass,            \
                             std::uint64_t& evaluations) {                                      \
    return sweep(rows, pass, evaluations);                                                      \
  }                                                                                             \
  HWY_ATTR bool measure_pushed_##Kind(const LoneView<Real>& rows, const LonePass<Real>& pass) { \
    return measure_pushed(rows, pass);                                                          \
  }                                                                                             \
  HWY_ATTR std::size_t next_crossing_##Kind(const LoneView<Real>& rows, const Real* travel2,    \
                                            std::size_t from) {                                 \
    return next_crossing(rows, travel2, from);                                                  \
  }
WEFT_LONE_KERNELS(float, f32)
WEFT_LONE_KERNELS(double, f64)
#undef WEFT_LONE_KERNELS

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
