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

inline constexpr std::ptrdiff_t kTriples = 3 * kMeshBlock;  ///< numbers a slot

/// Brings the triples of one slot's neighbours together.
template <class Real>
HWY_INLINE void gather(const Index* neighbour, const Real* from, Real* to) {
  for (std::ptrdiff_t k = 0; k < kMeshBlock; ++k)
    std::memcpy(to + 3 * k, from + 3 * static_cast<std::ptrdiff_t>(neighbour[k]), 3 * sizeof(Real));
}

/// Forces on one block: gather everything first, because vectors that span what was just written
/// piece by piece would wait for it; then add up slot by slot.
template <class Real>
HWY_INLINE void block_forces(const MeshView<Real>& mesh, const MeshBlock<Real>& block,
                             std::ptrdiff_t first, const Real* x, const Real* v, Real* force) {
  using D = hn::CappedTag<Real, 16>;
  const D d;
  using V = hn::Vec<D>;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const std::ptrdiff_t count =
      std::min<std::ptrdiff_t>(kMeshBlock, mesh.first + mesh.count - first);
  const int slots = block.near + block.far;
  Real* const places = mesh.gathered;
  Real* const speeds = places + slots * kTriples;
  Real* const own_x = speeds + block.near * kTriples;
  Real *const own_v = own_x + kTriples, *const sum = own_v + kTriples;
  for (int s = 0; s < slots; ++s)
    gather(block.neighbour + s * kMeshBlock, x, places + s * kTriples);
  for (int s = 0; s < block.near; ++s)
    gather(block.neighbour + s * kMeshBlock, v, speeds + s * kTriples);
  std::copy_n(x + 3 * first, 3 * count, own_x);
  std::copy_n(v + 3 * first, 3 * count, own_v);

  const V one = hn::Set(d, Real(1)), damping = hn::Set(d, mesh.damping_per_stiffness),
          smallest = hn::Set(d, Real(kSmallestSquaredLength));
  for (std::ptrdiff_t k = 0; k < kMeshBlock; k += lanes) {
    const auto x0 = load_particles(d, own_x + 3 * k), v0 = load_particles(d, own_v + 3 * k);
    Triple<V> f{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int s = 0; s < block.near; ++s) {
      const std::ptrdiff_t at = s * kMeshBlock + k;
      const auto way = load_particles(d, places + 3 * at) - x0;
      const auto speed = load_particles(d, speeds + 3 * at) - v0;
      const SpringLaw<D> law{one, hn::LoadU(d, block.rest_length + at), damping, smallest};
      const V pull = spring(d, law, hn::LoadU(d, block.stiffness + at), way, speed);
      f = fused(d, way, hn::Sub(pull, hn::LoadU(d, block.bending_weight + at)), f);
    }
    for (int s = block.near; s < slots; ++s) {
      const std::ptrdiff_t at = s * kMeshBlock + k;
      const auto way = load_particles(d, places + 3 * at) - x0;
      f = fused_minus(d, way, hn::LoadU(d, block.bending_weight + at), f);
    }
    store_particles(d, f, sum + 3 * k);
  }
  std::copy_n(sum, 3 * count, force + 3 * first);
}

template <class Real>
HWY_INLINE void all_forces(const MeshView<Real>& mesh, const Real* x, const Real* v, Real* force) {
  for (int b = 0; b < mesh.blocks; ++b)
    block_forces(mesh, mesh.block[b], mesh.first + std::ptrdiff_t{b} * kMeshBlock, x, v, force);
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
