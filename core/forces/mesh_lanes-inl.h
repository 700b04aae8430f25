// Loads and stores of particles' triples by lanes, for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_MESH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_MESH_LANES_INL_H
#undef WEFT_MESH_LANES_INL_H
#else
#define WEFT_MESH_LANES_INL_H
#endif

#include "core/forces/kick-inl.h"
#include "core/forces/mesh_view.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A particle's three numbers and the first of the next particle, which does not exist for the
/// model's last one.
/// @param from   numbers of the block's first particle
/// @param spare  whether this may be the last one
template <class D4>
HWY_INLINE hn::Vec<D4> load_quad(D4 d, const float* from, std::ptrdiff_t offset,
                                 std::ptrdiff_t last, bool spare) {
  if (spare && offset == last) {
    HWY_ALIGN float numbers[4] = {from[offset], from[offset + 1], from[offset + 2], 0};
    return hn::Load(d, numbers);
  }
  return hn::LoadU(d, from + offset);
}

#if HWY_TARGET != HWY_SCALAR
/// Every fourth lane's particle, as consecutive quads.
/// @param offsets  of the first of them
template <bool MeetsLast, class D>
HWY_INLINE hn::Vec<D> every_fourth(D d, const float* from, const MeshOffset* offsets,
                                   std::ptrdiff_t last) {
  const hn::CappedTag<float, 4> four;
  const auto p0 = load_quad(four, from, offsets[0], last, MeetsLast);
  if constexpr (hn::MaxLanes(d) == 4) {
    return p0;
  } else {
    const auto p1 = load_quad(four, from, offsets[4], last, MeetsLast);
    if constexpr (hn::MaxLanes(d) == 8) {
      return hn::Combine(d, p1, p0);
    } else {
      const hn::Half<D> half;
      const auto p2 = load_quad(four, from, offsets[8], last, MeetsLast);
      const auto p3 = load_quad(four, from, offsets[12], last, MeetsLast);
      return hn::Combine(d, hn::Combine(half, p3, p2), hn::Combine(half, p1, p0));
    }
  }
}
#endif

/// Gathers the vectors of one particle per lane.
/// @tparam MeetsLast  whether the model's last particle may be among them
template <bool MeetsLast, class D>
HWY_INLINE Triple<hn::Vec<D>> gather(D d, const float* from, const MeshOffset* offsets,
                                     std::ptrdiff_t last) {
#if HWY_TARGET != HWY_SCALAR
  // Whole particles, transposed: gathers of single numbers take several times as long.
  return transposed(d, every_fourth<MeetsLast>(d, from, offsets, last),
                    every_fourth<MeetsLast>(d, from, offsets + 1, last),
                    every_fourth<MeetsLast>(d, from, offsets + 2, last),
                    every_fourth<MeetsLast>(d, from, offsets + 3, last));
#else
  (void)last;
  const float* const p = from + std::ptrdiff_t{offsets[0]};
  return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[2])};
#endif
}
template <bool MeetsLast, class D>
HWY_INLINE Triple<hn::Vec<D>> gather(D d, const double* from, const MeshOffset* offsets,
                                     std::ptrdiff_t) {
  HWY_ALIGN double numbers[3][hn::MaxLanes(D())];
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      numbers[c][k] = from[std::ptrdiff_t{offsets[k]} + static_cast<std::ptrdiff_t>(c)];
  }
  return {hn::Load(d, numbers[0]), hn::Load(d, numbers[1]), hn::Load(d, numbers[2])};
}

/// Stores triples as quads, those of every fourth lane consecutively.
/// @param k   the first lane's index in the group
/// @param to  the group's quads
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void store_quads(D d, const Triple<hn::Vec<D>>& a, int k, Real* to) {
  HWY_ALIGN Real numbers[3][hn::MaxLanes(D())];
  hn::Store(a.x, d, numbers[0]);
  hn::Store(a.y, d, numbers[1]);
  hn::Store(a.z, d, numbers[2]);
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    Real* const at = to + 4 * quad_of_lane(static_cast<std::size_t>(k) + lane);
    for (std::size_t c = 0; c < 3; ++c) at[c] = numbers[c][lane];
    at[3] = 0;
  }
}
#if HWY_TARGET != HWY_SCALAR
template <class D>
HWY_INLINE void store_quads(D d, const Triple<hn::Vec<D>>& a, int k, float* to) {
  const hn::Repartition<double, D> wide;
  const auto zero = hn::Zero(d);
  const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(d, a.x, a.y)),
             xy23 = hn::BitCast(wide, hn::InterleaveUpper(d, a.x, a.y)),
             z01 = hn::BitCast(wide, hn::InterleaveLower(d, a.z, zero)),
             z23 = hn::BitCast(wide, hn::InterleaveUpper(d, a.z, zero));
  float* const at = to + k;
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(wide, xy01, z01)), d, at);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(wide, xy01, z01)), d, at + kMeshGroup);
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(wide, xy23, z23)), d, at + 2 * kMeshGroup);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(wide, xy23, z23)), d, at + 3 * kMeshGroup);
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
