#pragma once

#include "core/solver/implicit/implicit.h"

// Shared by the files of the implicit solver.

namespace weft {

/// One substep: constant inputs and changing state.
template <class Real>
struct Step {
  const ClothModel<Real>& model;
  const Surroundings<Real>& surroundings;
  const ImplicitDef& solver;
  Real dt;
  Grabs<Real>& grabs;
  ClothState<Real>& state;
  ImplicitWorkspace<Real>& work;
  Profile& profile;
  bool metered = false;              ///< `flows` are wanted
  bool damped = false;               ///< by backward Euler
  EnergyFlows flows = {};            ///< of this substep so far, without contact
  HeldForces<Real>* held = nullptr;  ///< if the forces of pins are wanted

  bool movable(std::size_t i) const { return state.inverse_mass[i] > 0; }
};

/// How the final velocity and its change follow from a particle's displacement: v' = rate
/// displacement - offset, M (rate v' - before) = forces.
template <class Real>
struct Scheme {
  Real rate;
  Vec3<Real> offset, before;

  Scheme(const Step<Real>& step, std::size_t i) {
    const ImplicitWorkspace<Real>& work = step.work;
    const Vec3<Real>& v = step.state.v[i];
    if (work.history[i] && !step.damped) {
      const Real half = 1 / (2 * step.dt);
      rate = 3 * half;
      offset = work.last_displacement[i] * half;
      before = (v * 4 - work.last_v[i]) * half;
    } else {
      rate = 1 / step.dt;
      offset = Vec3<Real>::Zero();
      before = v * rate;
    }
  }
};

/// Records where the live hands hold, for the coming tick. Allocates only if they are more, or
/// larger, than ever before.
template <class Real>
void take_hands(Step<Real>& step);

/// Solves for the displacements of a substep from `start_near`: `displacement`, and the resulting
/// `x` and `v`.
/// @param progress  fraction of the tick that has passed at its end, 0 to 1
/// @returns whether all its linear systems were solved
template <class Real>
bool solve_displacements(Step<Real>& step, Real progress);

/// Work of air, impulses and hands over the present displacements [J].
template <class Real>
double outer_work(const Step<Real>& step);

/// Adds the present displacements' share to the flows, if they are wanted: each force acts as it
/// is at the substep's end.
template <class Real>
void meter_displacements(Step<Real>& step);

/// Books the forces at the end of the present displacements, which act over them: of hands, and on
/// fixed particles.
template <class Real>
void book_forces(Step<Real>& step);

/// Takes back what this substep has booked, before it is solved in another way.
template <class Real>
void take_back_forces(Step<Real>& step);

/// Gives the hands what was booked in the substep that is over.
template <class Real>
void finish_forces(Step<Real>& step);

}  // namespace weft
