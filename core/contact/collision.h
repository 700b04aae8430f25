#pragma once

#include "core/cloth/cloth_state.h"
#include "core/contact/contact.h"
#include "core/contact/seed_contact.h"
#include "core/world/profile.h"

namespace weft {

/// What keeps the cloth off objects and itself while a solver moves it: one of the two models of
/// contact, the other is null; or none.
template <class Real>
struct Collision {
  Contact<Real>* weft = nullptr;
  SeedContact<Real>* seed = nullptr;

  bool empty() const { return !weft && !seed; }

  /// Between the kick and the drift of `dt` [s]: makes the velocities admissible.
  void before_drift(ClothState<Real>& state, Real dt, Profile& profile) const {
    if (weft) weft->resolve(state, dt, profile);
    if (seed) seed->separate(state, profile);
  }
  /// After the drift: puts back what got in.
  void after_drift(ClothState<Real>& state, Real dt, Profile& profile) const {
    if (seed) seed->collide(state, dt, profile);
  }
  /// At the end of a tick, after the closing kick.
  void settle(ClothState<Real>& state, Real dt, Profile& profile) const {
    if (weft) weft->settle(state, dt, profile);
  }
};

}  // namespace weft
