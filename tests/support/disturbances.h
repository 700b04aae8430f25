#pragma once

#include <algorithm>

#include "core/diagnostics/energies.h"
#include "core/world/world.h"
#include "tests/support/random.h"

namespace weft::test {

/// What hard shaking does to a cloth of one square metre that hangs from y = 0.
enum class Disturbance {
  noise,  ///< every free particle is given 20 m/s, the size of its velocity, in a random direction
  crush,  ///< all free particles are put into a ball of 1 mm
  teleport  ///< the first corner is moved by 3 m for a tenth of a second, then back
};

inline constexpr Disturbance kDisturbances[] = {Disturbance::noise, Disturbance::crush,
                                                Disturbance::teleport};

/// Of the disturbances drawn at random, so many are tried.
inline constexpr unsigned kDisturbanceSeeds = 8;

inline const char* name_of(Disturbance kind) {
  return kind == Disturbance::noise   ? "noise of 20 m/s"
         : kind == Disturbance::crush ? "all in a ball of 1 mm"
                                      : "pin 3 m away and back";
}

/// Number of different ones of a kind.
inline unsigned seeds_of(Disturbance kind) {
  return kind == Disturbance::teleport ? 1 : kDisturbanceSeeds;
}

/// What a disturbance did.
struct DisturbanceEffect {
  int rescues = 0;    ///< ticks that were taken back meanwhile
  double before = 0;  ///< energy before it [J]
  double work = 0;    ///< done on the cloth by throwing it or moving its particles and its pin [J]
  /// The most that the energy was, after any tick meanwhile, above that before and the work done so
  /// far [J].
  double excess = 0;
};

template <class Real>
double energy_of(const World<Real>& world) {
  return read_energies<Real>(world.model(), world.state(),
                             world.environment().gravity.template cast<Real>())
      .energies.total();
}

/// The size of the velocities of noise [m/s].
inline constexpr double kNoiseSpeed = 20;

/// Throws the free particles or puts them into the ball.
template <class Real>
void disturb_particles(ClothState<Real>& state, Disturbance kind, double noise_speed,
                       Random& random) {
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (state.inverse_mass[i] == 0) continue;
    if (kind == Disturbance::noise) {
      Vec3d v = random.vector(1);
      while (v.norm() > 1 || v.norm() < 1e-3) v = random.vector(1);
      state.v[i] = (v.normalized() * noise_speed).template cast<Real>();
    } else {
      state.x[i] = (Vec3d(0.5, -0.5, 0) + random.vector(5e-4)).template cast<Real>();
    }
  }
}

/// Does it to the world and declares the state good. A pin that stands still does no work, so all
/// of it is done at once where particles are moved or thrown.
/// @param seed  of the random directions and places
template <class Real>
DisturbanceEffect disturb(World<Real>& world, Disturbance kind, unsigned seed = 20,
                          double noise_speed = kNoiseSpeed) {
  DisturbanceEffect effect;
  effect.before = energy_of(world);
  const auto work_of = [&](auto&& change) {
    const double start = energy_of(world);
    change(world.state());
    world.accept_state();
    effect.work += energy_of(world) - start;
  };
  if (kind != Disturbance::teleport) {
    Random random(seed);
    work_of([&](ClothState<Real>& state) { disturb_particles(state, kind, noise_speed, random); });
    return effect;
  }
  const auto first = world.state().x.front();
  work_of([](ClothState<Real>& state) { state.x.front()[2] += Real(3); });
  for (int tick = 0; tick < 6; ++tick) {
    effect.rescues += world.step().divergence ? 1 : 0;
    effect.excess = std::max(effect.excess, energy_of(world) - effect.before - effect.work);
  }
  work_of([&](ClothState<Real>& state) { state.x.front() = first; });
  return effect;
}

}  // namespace weft::test
