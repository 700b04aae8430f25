#pragma once

#include <vector>

#include "core/contact/objects/contact.h"

namespace weft::test {

/// A few particles with springs between them and the simplest leapfrog, so that contact can be
/// tested without the cloth's solver: kick, contact, drift.
template <class Real>
struct Particles {
  struct Spring {
    Index i, j;
    double stiffness, rest;
  };
  ClothState<Real> state;
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  std::vector<Spring> springs;
  std::vector<Vec3d> forces;  ///< constant, one a particle [N]
  Vec3d gravity = Vec3d(0, -9.81, 0);
  double dashpot = 0;  ///< along every spring [N s/m]
  double tick_seconds = 1.0 / 60;
  int substeps = 40;
  Profile profile;

  Index add(const Vec3d& x, const Vec3d& v = Vec3d::Zero(), double mass = 1e-3) {
    state.x.push_back(x.cast<Real>());
    state.v.push_back(v.cast<Real>());
    state.inverse_mass.push_back(mass > 0 ? static_cast<Real>(1 / mass) : Real(0));
    forces.push_back(Vec3d::Zero());
    return static_cast<Index>(state.x.size()) - 1;
  }
  void join(Index i, Index j, double stiffness) {
    edges.push_back({std::min(i, j), std::max(i, j)});
    springs.push_back({i, j, stiffness, (position(i) - position(j)).norm()});
  }
  /// A triangle with its three edges.
  void add_triangle(Index i, Index j, Index k, double stiffness) {
    triangles.push_back({i, j, k});
    join(i, j, stiffness);
    join(j, k, stiffness);
    join(k, i, stiffness);
  }
  /// A square patch of side x side particles, row by row, with springs along its cells and across
  /// them.
  /// @param first  where the first particle is; rows go along z [m]
  /// @param along,across  stiffness of the springs [N/m]
  void add_patch(Index side, double cell, const Vec3d& first, double mass, double along,
                 double across) {
    for (Index r = 0; r < side; ++r) {
      for (Index c = 0; c < side; ++c)
        add(first + Vec3d(cell * c, 0, cell * r), Vec3d::Zero(), mass);
    }
    for (Index r = 0; r + 1 < side; ++r) {
      for (Index c = 0; c + 1 < side; ++c) {
        const Index i = r * side + c;
        triangles.push_back({i, i + side, i + 1});
        triangles.push_back({i + 1, i + side, i + side + 1});
      }
    }
    for (Index i = 0; i < side * side; ++i) {
      const bool right = i % side + 1 < side, down = i / side + 1 < side;
      if (right) join(i, i + 1, along);
      if (down) join(i, i + side, along);
      if (right && down) join(i + 1, i + side, across);
    }
  }
  Vec3d position(Index i) const {
    return state.x[static_cast<std::size_t>(i)].template cast<double>();
  }
  Vec3d velocity(Index i) const {
    return state.v[static_cast<std::size_t>(i)].template cast<double>();
  }
  double dt() const { return tick_seconds / substeps; }
  double kinetic_energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < state.v.size(); ++i) {
      if (state.inverse_mass[i] > 0)
        sum += 0.5 * static_cast<double>(state.v[i].squaredNorm() / state.inverse_mass[i]);
    }
    return sum;
  }
  Contact<Real> meet(const ContactDef& def, const std::vector<ColliderDef>& colliders,
                     Executor* executor = nullptr) const {
    return Contact<Real>({def}, colliders, make_patches(state.x, edges, triangles), executor,
                         nullptr);
  }

  void kick() {
    std::vector<Vec3d> f = forces;
    for (const Spring& s : springs) {
      const Vec3d along = position(s.j) - position(s.i);
      const double length = along.norm();
      if (!(length > 0)) continue;
      const Vec3d u = along / length;
      const double pull =
          s.stiffness * (length - s.rest) + dashpot * u.dot(velocity(s.j) - velocity(s.i));
      f[static_cast<std::size_t>(s.i)] += u * pull;
      f[static_cast<std::size_t>(s.j)] -= u * pull;
    }
    for (std::size_t i = 0; i < f.size(); ++i) {
      const auto w = static_cast<double>(state.inverse_mass[i]);
      if (w > 0) state.v[i] += ((f[i] * w + gravity) * dt()).template cast<Real>();
    }
  }
  void drift() {
    for (std::size_t i = 0; i < state.x.size(); ++i)
      state.x[i] += state.v[i] * static_cast<Real>(dt());
  }
  /// @param watch  watch(state before the drift), called after each drift
  template <class Watch>
  void step(Contact<Real>& contact, Watch&& watch) {
    profile.clear();
    contact.begin_tick(tick_seconds);
    for (int s = 0; s < substeps; ++s) {
      contact.note_motion(state);
      kick();
      const ClothState<Real> before = state;
      contact.resolve(state, static_cast<Real>(dt()), profile);
      contact.move_objects(state, static_cast<Real>(dt()), false);
      drift();
      watch(before);
    }
  }
  void step(Contact<Real>& contact) {
    step(contact, [](const ClothState<Real>&) {});
  }
};

}  // namespace weft::test
