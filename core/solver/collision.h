#pragma once

#include <cassert>
#include <limits>

#include "core/attachments/pin_drive.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/guard/cloth_guard.h"
#include "core/contact/objects/contact.h"
#include "core/contact/seed/seed_contact.h"
#include "core/profile.h"
#include "core/solver/constants.h"
#include "core/solver/held_forces.h"
#include "core/solver/work_meter.h"

// Interface of contact to the solvers.

namespace weft {

/// Contact and moving pins, as a solver calls them. Of the two contact models at most one is set:
/// the certified one with `objects`, `guard` or both, or `seed`. Moving pins are included because
/// they too act between kick and drift, and the meter because it reads velocities between them.
template <class Real>
struct Collision {
  Contact<Real>* objects = nullptr;
  SeedContact<Real>* seed = nullptr;
  ClothGuard<Real>* guard = nullptr;
  PinDrive<Real>* pins = nullptr;
  WorkMeter<Real>* meter = nullptr;  ///< if the work of all causes is wanted
  HeldForces<Real>* held = nullptr;  ///< if the forces of pins are wanted

  bool empty() const { return !objects && !seed && !guard && !pins; }

  /// Whether anything touches now, or was stopped before it did.
  bool touches(const ClothState<Real>& state) const {
    return (objects && objects->touches(state.x)) ||
           (guard && (guard->presses() || guard->stops())) || (seed && seed->touches());
  }

  /// Call before a kick, with the velocities of the last drift.
  void before_kick(const ClothState<Real>& state) const {
    if (objects) objects->note_motion(state);
  }
  /// Call between the kick and the drift of `dt` [s], before the motion is checked: where a pin
  /// holds against forces, these alone would give its particles a speed that none of them gets.
  /// @param force_ratio  impulse of a force that gives the velocities an impulse of 1 here [1]
  void drive_pins(ClothState<Real>& state, Real dt, Real force_ratio = 1) const {
    assert(dt > 0 && force_ratio >= 1);
    if (!pins) return;
    metered(state, [&] { pins->before_drift(state, dt, static_cast<double>(force_ratio)); });
  }
  /// Call between that and the drift: makes the velocities admissible.
  /// @param force_ratio  as for drive_pins
  void before_drift(ClothState<Real>& state, Real dt, Profile& profile,
                    Real force_ratio = 1) const {
    assert(dt > 0 && force_ratio >= 1);
    assert(!(objects && seed) && !(guard && seed) && "one model of contact");
    const StageTimer timer(profile, Stage::contact, 0);
    if (objects) objects->note_kicked(state, static_cast<double>(force_ratio));
    if (guard) guard->solve(state, dt, profile, force_ratio);
    lead_pins(state, dt);
    if (objects)
      objects->resolve(state, dt, profile, guard);
    else if (guard)
      guard->respond_alone(state, dt);
    if (seed) seed->separate(state, profile);
    const double truncated = guard ? guard->counts().truncated : 0;
    if (guard)
      guard->certify(
          state, dt, [this, &state] { return room(state); }, profile);
    if (objects &&
        !objects->move_objects(state, dt, guard && guard->counts().truncated > truncated)) {
      assert(guard && "objects stop only where the guard truncates");
      guard->stand_still();
    }
  }
  /// Lets moving pins lead their particles on, in turns with the rows between cloths: these share
  /// impulses out by mass, and against what a pin leads would give way to it only in part.
  void lead_pins(ClothState<Real>& state, Real dt) const {
    if (!pins || !guard || !pins->leads()) return;
    const Real enough = guard->residual(dt);
    metered(state, [&] { pins->lead_on(state, dt); });  // after the warm start
    Real given = enough;
    for (int turn = 0; turn < kPinTurns && given >= enough && guard->sweep(state) > 0; ++turn)
      metered(state, [&] { given = pins->lead_on(state, dt); });
  }
  /// Lets pins act, and books what they have given.
  template <class Act>
  void metered(const ClothState<Real>& state, Act&& act) const {
    if (meter) meter->before_drive(state.v);
    act();
    if (meter) meter->driven(state.v);
  }
  /// How far any particle may go, whichever way, before it may meet an object [m].
  Real room(const ClothState<Real>& state) const {
    return objects ? objects->calm_room(state) : std::numeric_limits<Real>::infinity();
  }
  /// Call after the drift: corrects penetrations.
  /// @param keeps_velocity  see ClothGuard::finish
  /// @return whether that may have changed a velocity, or with the seed's contact a position
  bool after_drift(ClothState<Real>& state, Real dt, Profile& profile,
                   bool keeps_velocity = true) const {
    const StageTimer timer(profile, Stage::contact, 0);
    const bool changed = guard && guard->finish(state, keeps_velocity);
    if (seed) seed->collide(state, dt, profile);
    return changed || seed;
  }
  /// Call at the end of a tick, after the closing kick, all of whose forces the velocities have.
  void settle(ClothState<Real>& state, Real dt, Profile& profile) const {
    assert(dt > 0);
    const StageTimer timer(profile, Stage::contact, 0);
    if (objects) objects->note_kicked(state);
    if (guard) guard->settle(state, dt, profile);
    if (pins) metered(state, [&] { pins->settle(state, dt); });
    lead_pins(state, dt);
    if (objects)
      objects->settle(state, dt, profile, guard);
    else if (guard)
      guard->sweep(state);
  }
};

}  // namespace weft
