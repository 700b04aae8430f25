// Self-collision of SeedContact: eqs. (11) and (12), and edge-edge pairs, which the seed lacked.

#include <algorithm>
#include <cassert>

#include "core/contact/seed/constants.h"
#include "core/contact/seed/seed_contact.h"
#include "core/geometry/distance.h"
#include "core/stop_signal.h"

namespace weft {

template <class Real>
bool SeedContact<Real>::are_neighbours(Index i, Index j) const {
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  assert(a < cloth_of_.size() && b < cloth_of_.size());
  if (cloth_of_[a] != cloth_of_[b]) return false;
  const Real reach = thickness_[static_cast<std::size_t>(cloth_of_[a])] * Real(kSeedNeighbourhood);
  return i == j || (rest_positions_[a] - rest_positions_[b]).squaredNorm() < reach * reach;
}

/// The larger thickness of two particles' cloths.
template <class Real>
Real SeedContact<Real>::thickness_between(Index i, Index j) const {
  const auto of = [&](Index k) {
    return thickness_[static_cast<std::size_t>(cloth_of_[static_cast<std::size_t>(k)])];
  };
  return std::max(of(i), of(j));
}

template <class Real>
void SeedContact<Real>::prepare_self_contact() {
  if (def_.has_self_contact()) pairs_.reserve(kSeedPairsPerParticle * rest_positions_.size());
}

/// Particle pairs, eq. (11).
template <class Real>
std::uint64_t SeedContact<Real>::find_particle_pairs(const Vec3Array<Real>& x) {
  std::uint64_t tests = 0;
  trees_.particles(x, thickest_ / 2).for_each_own_pair([&](Index i, Index j) {
    stop_point(++tests);
    if (are_neighbours(i, j)) return;
    const Vec3<Real> away = x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(j)];
    const Real distance = away.norm();
    if (!(distance < thickness_between(i, j)) || !(distance > 0)) return;
    pairs_.push_back({{i, j, i, i}, {Real(1), Real(-1), Real(0), Real(0)}, away / distance});
  });
  return tests;
}

/// Particle-triangle pairs, eq. (12).
template <class Real>
std::uint64_t SeedContact<Real>::find_triangle_pairs(const Vec3Array<Real>& x) {
  std::uint64_t tests = 0;
  const auto at = [&](Index i) -> const Vec3<Real>& { return x[static_cast<std::size_t>(i)]; };
  const BottomUpTree<Real>& particles = trees_.particles(x, thickest_ / 2);
  const BottomUpTree<Real>& triangles = trees_.triangles_in(triangles_, [&](const Triangle& t) {
    return proximity_box<Real>(at(t[0]), at(t[1]), at(t[2]), thickest_);
  });
  particles.for_each_pair(triangles, [&](Index i, Index triangle) {
    stop_point(++tests);
    const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
    for (const Index corner : t)
      if (are_neighbours(i, corner)) return;
    const seed::Proximity<Real> p =
        seed::proximity<Real>(at(i), at(t[0]), at(t[1]), at(t[2]), thickness_between(i, t[0]));
    if (!p.near) return;
    pairs_.push_back({{i, t[0], t[1], t[2]},
                      {Real(1), -p.weight[0], -p.weight[1], -p.weight[2]},
                      p.distance < 0 ? (-p.normal).eval() : p.normal});
  });
  return tests;
}

/// Edge-edge pairs.
template <class Real>
std::uint64_t SeedContact<Real>::find_edge_pairs(const Vec3Array<Real>& x) {
  std::uint64_t tests = 0;
  const auto at = [&](Index i) -> const Vec3<Real>& { return x[static_cast<std::size_t>(i)]; };
  trees_.edges(x, edges_, thickest_ / 2).for_each_own_pair([&](Index first, Index second) {
    stop_point(++tests);
    const Edge& a = edges_[static_cast<std::size_t>(first)];
    const Edge& b = edges_[static_cast<std::size_t>(second)];
    for (const Index i : a) {
      for (const Index j : b)
        if (are_neighbours(i, j)) return;
    }
    const SegmentPoints<Real> nearest =
        closest_of_segments<Real>(at(a[0]), at(a[1]), at(b[0]), at(b[1]));
    if (!is_within_edge(nearest.s) || !is_within_edge(nearest.t)) return;
    const Vec3<Real> away = nearest.p - nearest.q;
    const Real distance = away.norm();
    if (!(distance < thickness_between(a[0], b[0])) || !(distance > 0)) return;
    pairs_.push_back({{a[0], a[1], b[0], b[1]},
                      {Real(1) - nearest.s, nearest.s, nearest.t - Real(1), -nearest.t},
                      away / distance});
  });
  return tests;
}

/// Removes the approach of a pair's sides along its normal from the velocities.
template <class Real>
void SeedContact<Real>::take_approach(const SelfPair& pair, ClothState<Real>& state) {
  Real speed = 0;
  std::array<Real, 4> inverse_mass;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(pair.particle[k]);
    speed += pair.weight[k] * pair.normal.dot(state.v[i]);
    inverse_mass[k] = state.inverse_mass[i];
  }
  if (!(speed < 0)) return;
  touches_ = true;
  const Real impulse = seed::weighted_impulse(-speed, pair.weight, inverse_mass);
  for (std::size_t k = 0; k < 4; ++k)
    state.v[static_cast<std::size_t>(pair.particle[k])] +=
        pair.normal * (pair.weight[k] * inverse_mass[k] * impulse);
}

template <class Real>
void SeedContact<Real>::separate(ClothState<Real>& state, Profile& profile) {
  assert(state.x.size() == rest_positions_.size() && state.v.size() == state.x.size());
  if (!def_.has_self_contact()) return;
  pairs_.clear();
  {
    const StageTimer timer(profile, Stage::broad_phase, 0);
    std::uint64_t tests = 0;
    if (def_.self == SelfContact::particles)
      tests += find_particle_pairs(state.x);
    else
      tests += find_triangle_pairs(state.x);
    if (def_.self == SelfContact::triangles_and_edges) tests += find_edge_pairs(state.x);
    profile[Stage::broad_phase].work += tests;
    profile[Stage::narrow_phase].work += tests;
  }
  const StageTimer timer(profile, Stage::self_contact,
                         pairs_.size() * static_cast<std::size_t>(def_.passes));
  for (int pass = 0; pass < def_.passes; ++pass) {
    stop_point();
    for (const SelfPair& pair : pairs_) take_approach(pair, state);
  }
}

#define WEFT_INSTANTIATE(Real)                                                           \
  template bool SeedContact<Real>::are_neighbours(Index, Index) const;                   \
  template Real SeedContact<Real>::thickness_between(Index, Index) const;                \
  template void SeedContact<Real>::prepare_self_contact();                               \
  template std::uint64_t SeedContact<Real>::find_particle_pairs(const Vec3Array<Real>&); \
  template std::uint64_t SeedContact<Real>::find_triangle_pairs(const Vec3Array<Real>&); \
  template std::uint64_t SeedContact<Real>::find_edge_pairs(const Vec3Array<Real>&);     \
  template void SeedContact<Real>::take_approach(const SelfPair&, ClothState<Real>&);    \
  template void SeedContact<Real>::separate(ClothState<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
