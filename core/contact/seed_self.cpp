// Self-collision of SeedContact: eqs. (11) and (12), and edge-edge pairs, which the seed lacked.

#include <algorithm>

#include "core/contact/seed_contact.h"
#include "core/geometry/distance.h"

namespace weft {
namespace {

/// Particles of one cloth that lie nearer than this many thicknesses in the fabric are neighbours;
/// contact between them would keep the cloth from being one.
constexpr double kNeighbourhood = 1.5;

/// Pairs of edges that are closest nearer to an end than this belong to a particle and a triangle.
constexpr double kEdgeEnd = 0.01;

}  // namespace

template <class Real>
bool SeedContact<Real>::are_neighbours(Index i, Index j) const {
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  if (cloth_of_[a] != cloth_of_[b]) return false;
  const Real reach = thickness_[static_cast<std::size_t>(cloth_of_[a])] * Real(kNeighbourhood);
  return i == j || (rest_positions_[a] - rest_positions_[b]).squaredNorm() < reach * reach;
}

/// Takes out of the velocities what brings two weighted points nearer along the normal.
/// @param weight  positive on the side to which the normal points, negative on the other
template <class Real>
void SeedContact<Real>::take_approach(ClothState<Real>& state, const std::array<Index, 4>& particle,
                                      const std::array<Real, 4>& weight,
                                      const Vec3<Real>& normal) const {
  Real speed = 0;
  std::array<Real, 4> inverse_mass;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(particle[k]);
    speed += weight[k] * normal.dot(state.v[i]);
    inverse_mass[k] = state.inverse_mass[i];
  }
  if (!(speed < 0)) return;
  const Real impulse = seed::weighted_impulse(-speed, weight, inverse_mass);
  for (std::size_t k = 0; k < 4; ++k)
    state.v[static_cast<std::size_t>(particle[k])] +=
        normal * (weight[k] * inverse_mass[k] * impulse);
}

template <class Real>
std::uint64_t SeedContact<Real>::separate_particles(ClothState<Real>& state) {
  std::uint64_t tests = 0;
  trees_.particles(state.x, thickest_ / 2).for_each_own_pair([&](Index a, Index b) {
    ++tests;
    if (are_neighbours(a, b)) return;
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const Real h = std::max(thickness_[static_cast<std::size_t>(cloth_of_[i])],
                            thickness_[static_cast<std::size_t>(cloth_of_[j])]);
    const Vec3<Real> away = state.x[i] - state.x[j];
    const Real distance = away.norm();
    if (!(distance < h) || !(distance > 0)) return;
    const Vec3<Real> normal = away / distance;
    const Real approach = normal.dot(state.v[j] - state.v[i]);
    if (!(approach > 0)) return;
    const Real impulse = seed::pair_impulse(approach, state.inverse_mass[i], state.inverse_mass[j]);
    state.v[i] += normal * (impulse * state.inverse_mass[i]);
    state.v[j] -= normal * (impulse * state.inverse_mass[j]);
  });
  return tests;
}

template <class Real>
std::uint64_t SeedContact<Real>::separate_triangles(ClothState<Real>& state) {
  std::uint64_t tests = 0;
  const Vec3Array<Real>& x = state.x;
  const auto at = [&](Index i) -> const Vec3<Real>& { return x[static_cast<std::size_t>(i)]; };
  const BottomUpTree<Real>& particles = trees_.particles(x, Real(0));
  const BottomUpTree<Real>& triangles = trees_.triangles_in(triangles_, [&](const Triangle& t) {
    return proximity_box<Real>(at(t[0]), at(t[1]), at(t[2]), thickest_);
  });
  particles.for_each_pair(triangles, [&](Index i, Index triangle) {
    ++tests;
    const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
    for (const Index corner : t)
      if (are_neighbours(i, corner)) return;
    const Real h =
        std::max(thickness_[static_cast<std::size_t>(cloth_of_[static_cast<std::size_t>(i)])],
                 thickness_[static_cast<std::size_t>(cloth_of_[static_cast<std::size_t>(t[0])])]);
    const seed::Proximity<Real> p = seed::proximity<Real>(at(i), at(t[0]), at(t[1]), at(t[2]), h);
    if (!p.near) return;
    const Vec3<Real> normal = p.distance < 0 ? (-p.normal).eval() : p.normal;
    take_approach(state, {i, t[0], t[1], t[2]}, {Real(1), -p.weight[0], -p.weight[1], -p.weight[2]},
                  normal);
  });
  return tests;
}

template <class Real>
std::uint64_t SeedContact<Real>::separate_edges(ClothState<Real>& state) {
  std::uint64_t tests = 0;
  const Vec3Array<Real>& x = state.x;
  const auto at = [&](Index i) -> const Vec3<Real>& { return x[static_cast<std::size_t>(i)]; };
  const auto inside = [](Real s) { return s > Real(kEdgeEnd) && s < Real(1 - kEdgeEnd); };
  trees_.edges(x, edges_, thickest_ / 2).for_each_own_pair([&](Index first, Index second) {
    ++tests;
    const Edge& a = edges_[static_cast<std::size_t>(first)];
    const Edge& b = edges_[static_cast<std::size_t>(second)];
    for (const Index i : a) {
      for (const Index j : b)
        if (are_neighbours(i, j)) return;
    }
    const Real h =
        std::max(thickness_[static_cast<std::size_t>(cloth_of_[static_cast<std::size_t>(a[0])])],
                 thickness_[static_cast<std::size_t>(cloth_of_[static_cast<std::size_t>(b[0])])]);
    const SegmentPoints<Real> nearest =
        closest_of_segments<Real>(at(a[0]), at(a[1]), at(b[0]), at(b[1]));
    if (!inside(nearest.s) || !inside(nearest.t)) return;
    const Vec3<Real> away = nearest.p - nearest.q;
    const Real distance = away.norm();
    if (!(distance < h) || !(distance > 0)) return;
    take_approach(state, {a[0], a[1], b[0], b[1]},
                  {Real(1) - nearest.s, nearest.s, nearest.t - Real(1), -nearest.t},
                  away / distance);
  });
  return tests;
}

template <class Real>
void SeedContact<Real>::separate(ClothState<Real>& state, Profile& profile) {
  if (def_.self == SelfContact::none) return;
  const StageTimer timer(profile, Stage::contact, 0);
  std::uint64_t tests = 0;
  for (int pass = 0; pass < def_.passes; ++pass) {
    if (def_.self == SelfContact::particles) {
      tests += separate_particles(state);
      continue;
    }
    tests += separate_triangles(state);
    if (def_.self == SelfContact::triangles_and_edges) tests += separate_edges(state);
  }
  profile[Stage::broad_phase].work += tests;
  profile[Stage::narrow_phase].work += tests;
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template bool SeedContact<Real>::are_neighbours(Index, Index) const;                           \
  template void SeedContact<Real>::take_approach(ClothState<Real>&, const std::array<Index, 4>&, \
                                                 const std::array<Real, 4>&, const Vec3<Real>&)  \
      const;                                                                                     \
  template std::uint64_t SeedContact<Real>::separate_particles(ClothState<Real>&);               \
  template std::uint64_t SeedContact<Real>::separate_triangles(ClothState<Real>&);               \
  template std::uint64_t SeedContact<Real>::separate_edges(ClothState<Real>&);                   \
  template void SeedContact<Real>::separate(ClothState<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
