#pragma once

#include "core/solver/implicit/implicit.h"

// What the files of the solver implicit share.

namespace weft {

/// One substep's constant inputs together with what it changes.
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
  bool damped = false;  ///< by backward Euler

  bool movable(std::size_t i) const { return state.inverse_mass[i] > 0; }
};

/// How the velocity at the end and its change follow from the way of a particle:
/// v' = rate way - offset, M (rate v' - before) = forces.
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
      offset = work.last_way[i] * half;
      before = (v * 4 - work.last_v[i]) * half;
    } else {
      rate = 1 / step.dt;
      offset = Vec3<Real>::Zero();
      before = v * rate;
    }
  }
};

/// Notes where the live hands hold, for the coming tick. Allocates only where there are more of
/// them, or larger ones, than ever before.
template <class Real>
void take_hands(Step<Real>& step);

/// Finds the ways of a substep: `way`, and `x` and `v` to which it leads.
/// @param progress  how much of the tick has passed at its end, 0 to 1
/// @returns whether all its linear systems were solved
template <class Real>
bool find_ways(Step<Real>& step, Real progress);

/// Work of air, shots and hands over the present ways [J].
template <class Real>
double outer_work(const Step<Real>& step);

}  // namespace weft
