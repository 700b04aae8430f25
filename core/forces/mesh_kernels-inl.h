// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_MESH_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_MESH_KERNELS_INL_H
#undef WEFT_MESH_KERNELS_INL_H
#else
#define WEFT_MESH_KERNELS_INL_H
#endif

#include <algorithm>
#include <cstring>

#include "core/forces/mesh_view.h"
#include "core/forces/spring_law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A particle's three numbers and one of the next particle, which the model's last one has not.
/// @param from   numbers of the block's first particle
/// @param spare  whether this may be the last one
template <class D4>
HWY_INLINE hn::Vec<D4> load_quad(D4 d, const float* from, std::ptrdiff_t way, std::ptrdiff_t last,
                                 bool spare) {
  if (spare && way == last) {
    HWY_ALIGN float numbers[4] = {from[3 * way], from[3 * way + 1], from[3 * way + 2], 0};
    return hn::Load(d, numbers);
  }
  return hn::LoadU(d, from + 3 * way);
}

/// Brings the triples of as many particles together as there are lanes.
/// @tparam MeetsLast  whether the model's last particle may be among them
template <bool MeetsLast, class D>
HWY_INLINE Triple<hn::Vec<D>> gather(D d, const float* from, const MeshWay* ways,
                                     std::ptrdiff_t last) {
#if HWY_TARGET != HWY_SCALAR
  // Whole particles, transposed: gathers of single numbers take several times as long.
  const hn::CappedTag<float, 4> four;
  const auto one = [&](int k) HWY_ATTR { return load_quad(four, from, ways[k], last, MeetsLast); };
  // Every fourth lane's particle from lane k on, as quads one behind the other.
  const auto every_fourth = [&](int k) HWY_ATTR {
    if constexpr (hn::MaxLanes(d) == 4) {
      return one(k);
    } else if constexpr (hn::MaxLanes(d) == 8) {
      return hn::Combine(d, one(k + 4), one(k));
    } else {
      const hn::Half<D> half;
      return hn::Combine(d, hn::Combine(half, one(k + 12), one(k + 8)),
                         hn::Combine(half, one(k + 4), one(k)));
    }
  };
  return transposed(d, every_fourth(0), every_fourth(1), every_fourth(2), every_fourth(3));
#else
  (void)last;
  const float* const p = from + 3 * std::ptrdiff_t{ways[0]};
  return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[2])};
#endif
}
template <bool MeetsLast, class D>
HWY_INLINE Triple<hn::Vec<D>> gather(D d, const double* from, const MeshWay* ways, std::ptrdiff_t) {
  HWY_ALIGN double numbers[3][hn::MaxLanes(D())];
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      numbers[c][k] = from[3 * std::ptrdiff_t{ways[k]} + static_cast<std::ptrdiff_t>(c)];
  }
  return {hn::Load(d, numbers[0]), hn::Load(d, numbers[1]), hn::Load(d, numbers[2])};
}

/// Forces on a group.
/// @param x,v  of the block's first particle
/// @param sum  forces as quads
template <bool MeetsLast, class Real>
HWY_INLINE void group_forces(const MeshGroup& group, const MeshWay* way, const Real* number,
                             std::ptrdiff_t last, Real damping_per_stiffness, const Real* x,
                             const Real* v, Real* sum) {
  using D = hn::CappedTag<Real, kMeshGroup>;
  const D d;
  using V = hn::Vec<D>;
  const V one = hn::Set(d, Real(1)), damping = hn::Set(d, damping_per_stiffness),
          smallest = hn::Set(d, Real(kSmallestSquaredLength));
  for (int k = 0; k < kMeshGroup; k += static_cast<int>(hn::Lanes(d))) {
    const MeshWay* ways = way + k;
    const Real* numbers = number + k;
    const auto x0 = gather<MeetsLast>(d, x, ways, last), v0 = gather<MeetsLast>(d, v, ways, last);
    ways += kMeshGroup;
    Triple<V> f{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int s = 0; s < group.near; ++s, ways += kMeshGroup, numbers += 3 * kMeshGroup) {
      const auto away = gather<MeetsLast>(d, x, ways, last) - x0;
      const auto speed = gather<MeetsLast>(d, v, ways, last) - v0;
      const SpringLaw<D> law{one, hn::LoadU(d, numbers), damping, smallest};
      const V pull = spring(d, law, hn::LoadU(d, numbers + kMeshGroup), away, speed);
      f = fused(d, away, hn::Sub(pull, hn::LoadU(d, numbers + 2 * kMeshGroup)), f);
    }
    for (int s = 0; s < group.far; ++s, ways += kMeshGroup, numbers += kMeshGroup) {
      const auto away = gather<MeetsLast>(d, x, ways, last) - x0;
      f = fused_minus(d, away, hn::LoadU(d, numbers), f);
    }
    hn::StoreInterleaved4(f.x, f.y, f.z, hn::Zero(d), d, sum + 4 * k);
  }
}

template <class Real>
HWY_INLINE void all_forces(const MeshView<Real>& mesh, const Real* x, const Real* v, Real* force) {
  HWY_ALIGN Real sum[4 * kMeshBlock];
  const MeshGroup* group = mesh.group;
  const MeshWay* way = mesh.way;
  const Real* number = mesh.number;
  for (std::ptrdiff_t begin = 0; begin < mesh.count; begin += kMeshBlock) {
    const std::ptrdiff_t first = mesh.first + begin;
    const std::ptrdiff_t end = std::min<std::ptrdiff_t>(begin + kMeshBlock, mesh.count);
    for (Real* to = sum; to < sum + 4 * (end - begin); to += 4 * kMeshGroup, ++group) {
      const std::ptrdiff_t last = mesh.last - first;
      const Real *const x0 = x + 3 * first, *const v0 = v + 3 * first;
      if (group->meets_last)
        group_forces<true>(*group, way, number, last, mesh.damping_per_stiffness, x0, v0, to);
      else
        group_forces<false>(*group, way, number, last, mesh.damping_per_stiffness, x0, v0, to);
      way += (1 + group->near + group->far) * kMeshGroup;
      number += (3 * group->near + group->far) * kMeshGroup;
    }
    // Back in their own order.
    for (std::ptrdiff_t i = begin; i < end; ++i)
      std::memcpy(force + 3 * (mesh.first + i), sum + 4 * mesh.place[i], 3 * sizeof(Real));
  }
}

HWY_ATTR void mesh_forces_f32(const MeshView<float>& mesh, const float* x, const float* v,
                              float* force) {
  all_forces(mesh, x, v, force);
}
HWY_ATTR void mesh_forces_f64(const MeshView<double>& mesh, const double* x, const double* v,
                              double* force) {
  all_forces(mesh, x, v, force);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
