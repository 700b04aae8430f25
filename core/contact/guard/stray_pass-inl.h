// The look for strays for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_STRAY_PASS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_STRAY_PASS_INL_H
#undef WEFT_STRAY_PASS_INL_H
#else
#define WEFT_STRAY_PASS_INL_H
#endif

#include <hwy/highway.h>

#include "core/contact/guard/stray_pass.h"
#include "core/math/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Particles whose displacements are added in columns of their own, so that any vector width has
/// the same sum.
constexpr std::size_t kStrayColumns = 16;

/// Looks at the particles from number n on, as many as a vector has.
/// @param sum   receives what each is off its path
/// @param most  largest squared distance of each lane
template <class D, class Real = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE void look_at(D d, const StrayPass<Real>& p, std::size_t n, V* sum, V& most,
                        std::vector<Index>& strays, bool& left) {
  V x[3], v[3], from[3], path[3], velocity[3], none;
  hn::LoadInterleaved3(d, p.x + 3 * n, x[0], x[1], x[2]);
  hn::LoadInterleaved3(d, p.v + 3 * n, v[0], v[1], v[2]);
  const auto numbers = [n](const Quad<Real>* at) { return reinterpret_cast<const Real*>(at + n); };
  hn::LoadInterleaved4(d, numbers(p.from), from[0], from[1], from[2], none);
  hn::LoadInterleaved4(d, numbers(p.path), path[0], path[1], path[2], none);
  hn::LoadInterleaved4(d, numbers(p.velocity), velocity[0], velocity[1], velocity[2], none);
  const V dt = hn::Set(d, p.dt), time = hn::Sub(hn::Set(d, p.elapsed), hn::LoadU(d, p.since + n));
  V displacement[3], squared[3];
  for (int k = 0; k < 3; ++k) {
    displacement[k] = hn::Add(hn::Sub(x[k], from[k]), hn::Mul(v[k], dt));
    const V expected = hn::Add(path[k], hn::Mul(velocity[k], time));
    const V off = hn::Sub(hn::Add(from[k], displacement[k]), expected);
    sum[k] = hn::Add(sum[k], off);
    const V own = hn::Sub(off, hn::Set(d, p.off[k]));
    squared[k] = hn::Mul(own, own);
  }
  hn::StoreInterleaved4(displacement[0], displacement[1], displacement[2], hn::Zero(d), d,
                        reinterpret_cast<Real*>(p.displacement + n));
  const V distance2 = hn::Add(hn::Add(squared[0], squared[1]), squared[2]);
  most = hn::Max(distance2, most);
  if (hn::AllTrue(d, hn::Le(distance2, hn::Set(d, p.soon2)))) return;
  Real each[hn::MaxLanes(d)];
  hn::StoreU(distance2, d, each);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    if (each[k] <= p.soon2) continue;
    strays.push_back(static_cast<Index>(n + k));
    left |= !(each[k] <= p.limit2);
  }
}

template <class Real>
HWY_ATTR StrayLook<Real> look(const StrayPass<Real>& p, std::size_t first, std::size_t end,
                              std::vector<Index>& strays) {
  const hn::CappedTag<Real, kStrayColumns> wide;
  const hn::CappedTag<Real, 1> single;
  using V = hn::Vec<decltype(wide)>;
  constexpr std::size_t kLanes = hn::MaxLanes(decltype(wide)()), kVectors = kStrayColumns / kLanes;
  StrayLook<Real> found;
  V sum[kVectors][3], most = hn::Zero(wide);
  for (V* of : sum) of[0] = of[1] = of[2] = hn::Zero(wide);
  std::size_t n = first;
  for (; n + kStrayColumns <= end; n += kStrayColumns) {
    for (std::size_t k = 0; k < kVectors; ++k)
      look_at(wide, p, n + k * kLanes, sum[k], most, strays, found.left);
  }
  Real columns[3][kStrayColumns];
  for (std::size_t k = 0; k < kVectors; ++k) {
    for (int c = 0; c < 3; ++c) hn::StoreU(sum[k][c], wide, columns[c] + k * kLanes);
  }
  auto last = hn::Zero(single);
  for (std::size_t k = 0; n < end; ++n, ++k) {
    hn::Vec<decltype(single)> one[3] = {hn::Zero(single), hn::Zero(single), hn::Zero(single)};
    look_at(single, p, n, one, last, strays, found.left);
    for (int c = 0; c < 3; ++c) columns[c][k] += hn::GetLane(one[c]);
  }
  const Real whole = hn::GetLane(hn::MaxOfLanes(wide, most)), rest = hn::GetLane(last);
  found.farthest2 = rest > whole ? rest : whole;
  for (std::size_t k = 0; k < kStrayColumns; ++k) {
    for (int c = 0; c < 3; ++c) found.sum.lanes[c] += columns[c][k];
  }
  return found;
}

WEFT_KERNEL(look);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
