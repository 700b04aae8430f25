// Forces of a mesh for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_MESH_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_MESH_KERNELS_INL_H
#undef WEFT_MESH_KERNELS_INL_H
#else
#define WEFT_MESH_KERNELS_INL_H
#endif

#include <algorithm>
#include <cstring>

#include "core/forces/kick-inl.h"
#include "core/forces/membrane_law-inl.h"
#include "core/forces/mesh_lanes-inl.h"
#include "core/forces/mesh_view.h"
#include "core/forces/spring_law-inl.h"
#include "core/math/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Position of the kernel in the ring of pulls.
template <class Real>
struct RingPlace {
  Real* ring;
  std::size_t at, size;  ///< in quads

  /// Returns the next slot.
  HWY_INLINE Real* next() {
    Real* const slot = ring + 4 * at;
    at = at + kMeshGroup == size ? 0 : at + kMeshGroup;
    return slot;
  }
};

/// Pulls of both triangles of each pair, and the strains that they leave for the next substep.
/// @tparam MeetsLast   as in `gather`
/// @tparam Remembered  whether the rates of the strains are the differences from those that the
///                     last substep left, or follow from the velocities
template <bool MeetsLast, bool Remembered, class Real>
struct PairLanes {
  using D = hn::CappedTag<Real, kMeshGroup>;
  using V = hn::Vec<D>;

  MembraneLaw<D> law;
  V stretches, shears;       ///< relaxation times over the substep
  const MeshOffset* corner;  ///< of the first lane
  const Real* shape;
  Real* strain;
  std::ptrdiff_t last;

  HWY_INLINE Triple<V> at(const Real* from, int c) const {
    return gather<MeetsLast>(D(), from, corner + c * kMeshGroup, last);
  }

  /// @param t      0 or 1
  /// @param x      of its corners
  /// @param v0,v1  of x0, and of x1 relative to that
  HWY_INLINE CornerDifferences<V> pulls(int t, const CornerDifferences<V>& x, const Real* v,
                                        const Triple<V>& v0, const Triple<V>& v1) const {
    const D d;
    const auto number = [&](int n)
                            HWY_ATTR { return hn::LoadU(d, shape + (4 * t + n) * kMeshGroup); };
    const TriangleShape<V> own{number(0), number(1), number(2), number(3)};
    const Strained<D> now(d, law, own, x);
    Real* const kept = strain + 3 * t * kMeshGroup;
    StrainLanes<V> e = now.strain;
    if constexpr (Remembered) {
      const auto grown = [&](V strain_now, int n, V substeps) HWY_ATTR {
        const V before = hn::LoadU(d, kept + n * kMeshGroup);
        return fused(d, substeps, hn::Sub(strain_now, before), strain_now);
      };
      e = {grown(e.u, 0, stretches), grown(e.v, 1, stretches), grown(e.shear, 2, shears)};
    } else {
      const StrainLanes<V> rates = now.rates(d, law, own, {v1, at(v, 2 + t) - v0});
      e = {hn::Add(e.u, rates.u), hn::Add(e.v, rates.v), hn::Add(e.shear, rates.shear)};
    }
    hn::StoreU(now.strain.u, d, kept);
    hn::StoreU(now.strain.v, d, kept + kMeshGroup);
    hn::StoreU(now.strain.shear, d, kept + 2 * kMeshGroup);
    return now.pulls(d, law, own, e);
  }
};

/// Adds the pulls of bending between the corners of a pair.
/// @param link  weights of the six links, of the first lane
/// @param x     of corners 1, 2, 3 from corner 0
template <class D, class Real, class V = hn::Vec<D>>
HWY_INLINE void add_links(D d, const Real* link, const Triple<V> (&x)[3], Triple<V> (&pull)[3]) {
  const auto weight = [&](int n) HWY_ATTR { return hn::LoadU(d, link + n * kMeshGroup); };
  for (int c = 0; c < 3; ++c) pull[c] = fused(d, x[c], weight(c), pull[c]);
  int n = 3;
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 3; ++b, ++n) {
      const Triple<V> more = (x[b] - x[a]) * weight(n);
      pull[b] = pull[b] + more;
      pull[a] = pull[a] - more;
    }
  }
}

/// Where the kernel is in the lists of pairs.
template <class Real>
struct PairPlace {
  const MeshOffset* corner;
  const Real *shape, *link;  ///< link: null without bending
  Real* strain;

  HWY_INLINE void next() {
    corner += kPairCorners * kMeshGroup;
    shape += kPairNumbers * kMeshGroup;
    strain += kPairStrains * kMeshGroup;
    if (link != nullptr) link += kPairLinks * kMeshGroup;
  }
};

/// Stores in the ring the pulls of a group of pairs of triangles at their corners.
/// @param x,v  of the block's first particle
template <bool MeetsLast, bool Remembered, class Real>
HWY_INLINE void pull_pairs(const MeshView<Real>& mesh, const PairPlace<Real>& at,
                           std::ptrdiff_t last, const Real* x, const Real* v,
                           RingPlace<Real>& ring) {
  using Lanes = PairLanes<MeetsLast, Remembered, Real>;
  using V = typename Lanes::V;
  const typename Lanes::D d;
  const MembraneLaw<typename Lanes::D> law(d, mesh.tensor);
  const V stretches = hn::Set(d, mesh.tensor.stretch_time * mesh.substeps_per_second),
          shears = hn::Set(d, mesh.tensor.shear_time * mesh.substeps_per_second);
  Real* const slots[kPairCorners] = {ring.next(), ring.next(), ring.next(), ring.next()};
  for (int k = 0; k < kMeshGroup; k += static_cast<int>(hn::Lanes(d))) {
    const Lanes pair{law, stretches, shears, at.corner + k, at.shape + k, at.strain + k, last};
    const auto x0 = pair.at(x, 0);
    const Triple<V> from[3] = {pair.at(x, 1) - x0, pair.at(x, 2) - x0, pair.at(x, 3) - x0};
    Triple<V> v0{}, v1{};
    if constexpr (!Remembered) {
      v0 = pair.at(v, 0);
      v1 = pair.at(v, 1) - v0;
    }
    const CornerDifferences<V> first = pair.pulls(0, {from[0], from[1]}, v, v0, v1),
                               second = pair.pulls(1, {from[0], from[2]}, v, v0, v1);
    Triple<V> pull[3] = {first.d1 + second.d1, first.d2, second.d2};
    if (at.link != nullptr) add_links(d, at.link + k, from, pull);
    for (int c = 0; c < 3; ++c) store_quads(d, pull[c], k, slots[c + 1]);
    const V zero = hn::Zero(d);
    store_quads(d, Triple<V>{zero, zero, zero} - (pull[0] + (pull[1] + pull[2])), k, slots[0]);
  }
}

/// Pulls on a group's members by later neighbours; also stored in the ring.
/// @param x,v  of the block's first particle
/// @param sum  forces as quads
template <bool MeetsLast, class Real>
HWY_INLINE void pull_group(const MeshView<Real>& mesh, const MeshGroup& group,
                           const MeshOffset* offset, const Real* number, std::ptrdiff_t last,
                           const Real* x, const Real* v, RingPlace<Real>& ring, Real* sum) {
  using D = hn::CappedTag<Real, kMeshGroup>;
  const D d;
  using V = hn::Vec<D>;
  const V one = hn::Set(d, Real(1)), damping = hn::Set(d, mesh.damping_per_stiffness),
          smallest = hn::Set(d, Real(kSmallestSquaredLength));
  const RingPlace<Real> start = ring;
  for (int k = 0; k < kMeshGroup; k += static_cast<int>(hn::Lanes(d))) {
    const MeshOffset* offsets = offset + k;
    const Real* numbers = number + k;
    ring = start;
    Triple<V> f{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const auto x0 = gather<MeetsLast>(d, x, offsets, last),
               v0 = group.near > 0 ? gather<MeetsLast>(d, v, offsets, last) : f;
    offsets += kMeshGroup;
    const auto add = [&](const Triple<V>& pull) HWY_ATTR {
      f = f + pull;
      store_quads(d, pull, k, ring.next());
    };
    for (int s = 0; s < group.near; ++s, offsets += kMeshGroup, numbers += 3 * kMeshGroup) {
      const auto away = gather<MeetsLast>(d, x, offsets, last) - x0;
      const auto speed = gather<MeetsLast>(d, v, offsets, last) - v0;
      const SpringLaw<D> law{one, hn::LoadU(d, numbers), damping, smallest};
      const V pull = spring(d, law, hn::LoadU(d, numbers + kMeshGroup), away, speed);
      add(away * hn::Sub(pull, hn::LoadU(d, numbers + 2 * kMeshGroup)));
    }
    for (int s = 0; s < group.far; ++s, offsets += kMeshGroup, numbers += kMeshGroup)
      add((gather<MeetsLast>(d, x, offsets, last) - x0) * hn::LoadU(d, numbers));
    store_quads(d, f, k, sum);
  }
}

/// Subtracts from a group's members the pulls that earlier neighbours have stored.
/// @param pull  positions of those pulls, by slot
/// @param sum   forces so far as quads
/// @param to    all forces, by particle of the block
template <class Real>
HWY_INLINE void pull_back(const MeshGroup& group, const MeshOffset* offset, const Real* ring,
                          const std::uint16_t* pull, const Real* sum, Real* to) {
  const hn::CappedTag<Real, 4> d;
  const std::uint16_t* const end = pull + kMeshGroup * group.earlier;
  for (std::size_t lane = 0; lane < 4; lane += hn::Lanes(d)) {
    const Real *const from = sum + lane, *const kept = ring + lane;
    const auto own = [&](std::size_t k) HWY_ATTR { return to + 4 * (offset[k] / 3) + lane; };
    // Four at a time: each waits only for its own sums.
    for (std::size_t k = 0; k < kMeshGroup; k += 4) {
      auto f0 = hn::Load(d, from + 4 * quad_of_lane(k)),
           f1 = hn::Load(d, from + 4 * quad_of_lane(k + 1)),
           f2 = hn::Load(d, from + 4 * quad_of_lane(k + 2)),
           f3 = hn::Load(d, from + 4 * quad_of_lane(k + 3));
      for (const std::uint16_t* p = pull + k; p < end; p += kMeshGroup) {
        f0 = hn::Sub(f0, hn::Load(d, kept + kPullUnit * p[0]));
        f1 = hn::Sub(f1, hn::Load(d, kept + kPullUnit * p[1]));
        f2 = hn::Sub(f2, hn::Load(d, kept + kPullUnit * p[2]));
        f3 = hn::Sub(f3, hn::Load(d, kept + kPullUnit * p[3]));
      }
      hn::Store(f0, d, own(k));
      hn::Store(f1, d, own(k + 1));
      hn::Store(f2, d, own(k + 2));
      hn::Store(f3, d, own(k + 3));
    }
  }
}

/// Calls take(first, count, force) for each block in order, with the forces as quads. The particles
/// passed to it are not read again.
/// @tparam Remembered  as in PairLanes
template <bool Remembered, class Real, class Take>
HWY_INLINE void for_each_block(const MeshView<Real>& mesh, const Real* x, const Real* v,
                               Take&& take) {
  HWY_ALIGN Real sum[4 * kMeshBlock], force[4 * kMeshBlock];
  const MeshGroup* group = mesh.group;
  const MeshOffset* offset = mesh.offset;
  const Real* number = mesh.number;
  const std::uint16_t* pull = mesh.pull;
  const MeshPairs* pairs = mesh.pairs;
  PairPlace<Real> pair{mesh.corner, mesh.shape, mesh.link, mesh.strain};
  RingPlace<Real> ring{mesh.ring, 0, mesh.ring_size};
  for (std::ptrdiff_t begin = 0; begin < mesh.count; begin += kMeshBlock) {
    const std::ptrdiff_t first = mesh.first + begin, last = 3 * (mesh.last - first);
    const std::ptrdiff_t count = std::min<std::ptrdiff_t>(kMeshBlock, mesh.count - begin);
    const int groups = static_cast<int>((count + kMeshGroup - 1) / kMeshGroup);
    const Real *const x0 = x + 3 * first, *const v0 = v + 3 * first;
    if (pairs != nullptr) {
      for (std::uint32_t g = 0; g < pairs->groups; ++g) {
        if (pairs->meets_last)
          pull_pairs<true, Remembered>(mesh, pair, last, x0, v0, ring);
        else
          pull_pairs<false, Remembered>(mesh, pair, last, x0, v0, ring);
        pair.next();
      }
      ++pairs;
    }
    const MeshOffset* own[kMeshBlock / kMeshGroup];
    for (int g = 0; g < groups; ++g) {
      Real* const to = sum + 4 * kMeshGroup * g;
      own[g] = offset;
      if (group[g].near + group[g].far == 0) {
        std::fill_n(to, 4 * kMeshGroup, Real(0));
        offset += kMeshGroup;
        continue;
      }
      if (group[g].meets_last)
        pull_group<true>(mesh, group[g], offset, number, last, x0, v0, ring, to);
      else
        pull_group<false>(mesh, group[g], offset, number, last, x0, v0, ring, to);
      offset += (1 + group[g].near + group[g].far) * kMeshGroup;
      number += (3 * group[g].near + group[g].far) * kMeshGroup;
    }
    for (int g = 0; g < groups; ++g) {
      pull_back(group[g], own[g], mesh.ring, pull, sum + 4 * kMeshGroup * g, force);
      pull += kMeshGroup * group[g].earlier;
    }
    group += groups;
    take(static_cast<std::size_t>(first), static_cast<std::size_t>(count), force);
  }
}

template <class Real>
HWY_ATTR void all_forces(const MeshView<Real>& mesh, const Real* x, const Real* v, Real* to) {
  for_each_block<false>(mesh, x, v, [&](std::size_t first, std::size_t count, const Real* force) {
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(to + 3 * (first + i), force + 4 * i, 3 * sizeof(Real));
  });
}

template <bool Remembered, class Real>
HWY_INLINE void kick_blocks(const MeshView<Real>& mesh, const KickLaw<Real>& law,
                            const KickedParticles<Real>& particles, const Real* x, Real* v) {
  for_each_block<Remembered>(
      mesh, x, v, [&](std::size_t first, std::size_t count, const Real* force) HWY_ATTR {
        for_each_vector<Real, kMeshGroup>(count, [&](auto d, std::size_t i) HWY_ATTR {
          Triple<hn::Vec<decltype(d)>> f;
          auto spare = hn::Zero(d);
          hn::LoadInterleaved4(d, force + 4 * i, f.x, f.y, f.z, spare);
          kick_particles(d, law, particles, first + i, f, v, v);
        });
      });
}

template <class Real>
HWY_ATTR void kick_all(const MeshView<Real>& mesh, const KickLaw<Real>& law,
                       const KickedParticles<Real>& particles, const Real* x, Real* v) {
  if (mesh.pairs != nullptr && mesh.substeps_per_second > 0)
    kick_blocks<true>(mesh, law, particles, x, v);
  else
    kick_blocks<false>(mesh, law, particles, x, v);
}

WEFT_KERNEL(all_forces);
WEFT_KERNEL(kick_all);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
