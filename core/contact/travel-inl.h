// Displacements of particles for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_TRAVEL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_TRAVEL_INL_H
#undef WEFT_TRAVEL_INL_H
#else
#define WEFT_TRAVEL_INL_H
#endif

#include <hwy/highway.h>

#include "core/contact/travel.h"
#include "core/math/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Squared lengths of the displacement now and after the drift, for particles from number n on.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE bool travel_of(D d, const TravelPass<Real>& p, std::size_t n) {
  hn::Vec<D> x[3], v[3], from[3];
  hn::LoadInterleaved3(d, p.x + 3 * n, x[0], x[1], x[2]);
  hn::LoadInterleaved3(d, p.v + 3 * n, v[0], v[1], v[2]);
  hn::LoadInterleaved3(d, p.from + 3 * n, from[0], from[1], from[2]);
  const auto dt = hn::Set(d, p.dt);
  auto now2 = hn::Zero(d), end2 = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto now = hn::Sub(x[k], from[k]), end = hn::Add(now, hn::Mul(v[k], dt));
    now2 = hn::Add(now2, hn::Mul(now, now));
    end2 = hn::Add(end2, hn::Mul(end, end));
  }
  hn::StoreU(hn::Max(now2, end2), d, p.travel2 + n);
  const auto left = hn::Sub(hn::LoadU(d, p.reach + n), hn::Set(d, p.less));
  const auto most2 = hn::Mul(left, hn::Abs(left));
  return hn::AllTrue(d, hn::And(hn::Le(now2, most2), hn::Le(end2, most2)));
}

template <class Real>
HWY_ATTR bool travel(const TravelPass<Real>& p) {
  const hn::ScalableTag<Real> wide;
  const hn::CappedTag<Real, 1> single;
  bool within = true;
  std::size_t n = 0;
  for (; n + hn::Lanes(wide) <= p.particles; n += hn::Lanes(wide)) within &= travel_of(wide, p, n);
  for (; n < p.particles; ++n) within &= travel_of(single, p, n);
  return within;
}

/// The largest number, the same for any vector width.
template <class Real>
HWY_ATTR Real deviation(const PathPass<Real>& p) {
  const hn::ScalableTag<Real> wide;
  const hn::CappedTag<Real, 1> single;
  const std::size_t count = 3 * p.particles;
  const auto at = [&](auto d, std::size_t k) HWY_ATTR {
    const auto path = hn::Mul(hn::LoadU(d, p.velocity + k), hn::Set(d, p.time));
    const auto step = hn::Mul(hn::LoadU(d, p.v + k), hn::Set(d, p.dt));
    const auto off = hn::Sub(hn::LoadU(d, p.x + k), hn::LoadU(d, p.base + k));
    return hn::Abs(hn::Add(off, hn::Sub(step, path)));
  };
  auto most = hn::Zero(wide);
  auto rest = hn::Zero(single);
  std::size_t k = 0;
  for (; k + hn::Lanes(wide) <= count; k += hn::Lanes(wide)) most = hn::Max(at(wide, k), most);
  for (; k < count; ++k) rest = hn::Max(at(single, k), rest);
  const Real whole = hn::GetLane(hn::MaxOfLanes(wide, most)), last = hn::GetLane(rest);
  return last > whole ? last : whole;
}

WEFT_KERNEL(travel);
WEFT_KERNEL(deviation);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
