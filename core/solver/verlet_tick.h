#pragma once

#include <cassert>

#include "core/solver/verlet.h"

// Shared by the files of verlet: the kicks of a tick and its inputs and state.

namespace weft {

/// v <- keep v + scaled_dt (f/m + g)
template <class Real>
struct Kick {
  Real keep, scaled_dt;
  double seconds;  ///< for which the forces act [s]
  /// What a force gives in that time over what is left of it in the velocity, `seconds` over
  /// `scaled_dt` [1]: drag has taken the rest. So an impulse J that velocities get after the kick
  /// is that of a force whose own impulse is J times this.
  Real force_ratio;
};

/// The three kicks of a tick. Opening and closing together make one full kick.
template <class Real>
struct Kicks {
  Kick<Real> opening, full, closing;

  Kicks(double dt, double damping) {
    assert(dt > 0 && damping >= 0);
    const double lost = 0.5 * damping * dt;
    const auto real = [](double value) { return static_cast<Real>(value); };
    const Real ratio = real(1 + lost);
    opening = {real(1 / (1 + lost)), real(0.5 * dt / (1 + lost)), dt / 2, ratio};
    full = {real((1 - lost) / (1 + lost)), real(dt / (1 + lost)), dt, ratio};
    closing = {real(1 - lost), real(0.5 * dt), dt / 2, 1};
  }
};

/// One tick: constant inputs and changing state.
template <class Real>
struct Tick {
  const ClothModel<Real>& model;
  const Surroundings<Real>& surroundings;
  const SolverDef& solver;
  Real dt;
  Grabs<Real>& grabs;
  const Collision<Real>& collision;
  ClothState<Real>& state;
  VerletWorkspace<Real>& work;
  Profile& profile;
  bool has_hands;            // or impulses
  bool has_impulses;         // of slings
  bool has_external_forces;  // impulses or air

  const ClothPart<Real>& part(std::size_t p) const { return model.parts[p]; }
  GridPass<Real>& grid(std::size_t p) const { return work.grids[p]; }
  bool by_rows(std::size_t p) const { return work.grids[p].fits(); }
  std::size_t parts() const { return model.parts.size(); }
  bool sleeps(std::size_t p) const { return state.is_asleep(p); }
  /// It sleeps, and its energy is known.
  bool rests(std::size_t p) const { return sleeps(p) && work.at_rest[p]; }
};

/// Shows the meter, if there is one, what a kick did.
template <class Real>
void meter_kick(const Tick<Real>& tick, const Kick<Real>& k,
                const Vec3Array<Real>* seen = nullptr) {
  if (!tick.collision.meter) return;
  const MeteredKick kick{static_cast<double>(k.keep), static_cast<double>(k.scaled_dt), k.seconds};
  const Vec3Array<Real>* external = tick.has_external_forces ? &tick.work.external : nullptr;
  tick.collision.meter->kicked(kick, {&tick.surroundings, external, &tick.grabs, seen},
                               tick.state.v);
}

/// Shows the state in which a kick finds the forces, where the forces of pins are wanted.
/// @param v  velocities that the dashpots see
template <class Real>
void hold_kick(const Tick<Real>& tick, const Kick<Real>& k, const Vec3Array<Real>& v) {
  if (tick.collision.held) tick.collision.held->act(tick.surroundings, tick.state.x, v, k.seconds);
}

/// What standing jaws hold does not move by what rounding took from it, added up.
template <class Real>
void keep_held(const Tick<Real>& tick) {
  if (!tick.collision.objects) return;
  tick.collision.objects->for_each_held([&tick](Index i) {
    const auto k = static_cast<std::size_t>(i);
    tick.work.remainder[k].setZero();
    for (std::size_t p = 0; p < tick.parts(); ++p) {
      if (tick.by_rows(p) && tick.part(p).particles.contains(i))
        tick.grid(p).forget_remainder(i, tick.state.x[k]);
    }
  });
}

inline std::size_t size_of(const IndexRange& range) {
  assert(range.count >= 0);
  return static_cast<std::size_t>(range.count);
}

/// The numbers of a range of particles, three each.
template <class Array>
auto* numbers(const IndexRange& range, Array& array) {
  assert(range.first >= 0 && static_cast<std::size_t>(range.end()) <= array.size());
  return (array.data() + range.first)->data();
}

}  // namespace weft
