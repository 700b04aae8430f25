#pragma once

#include "core/world/world.h"
#include "tests/support/random.h"

namespace weft::test {

/// What hard shaking does to a cloth of one square metre that hangs from y = 0.
enum class Insult {
  noise,    ///< every free particle gets a random velocity of 20 m/s
  crush,    ///< all free particles are put into a ball of 1 mm
  teleport  ///< the first corner is moved by 3 m for a tenth of a second, then back
};

inline constexpr Insult kInsults[] = {Insult::noise, Insult::crush, Insult::teleport};

inline const char* name_of(Insult kind) {
  return kind == Insult::noise   ? "noise of 20 m/s"
         : kind == Insult::crush ? "all in a ball of 1 mm"
                                 : "pin 3 m away and back";
}

/// Does it to the world and declares the state good.
/// @returns ticks that were taken back meanwhile
template <class Real>
int insult(World<Real>& world, Insult kind) {
  Random random(20);
  ClothState<Real>& state = world.state();
  int rescues = 0;
  for (std::size_t i = 0; i < state.x.size() && kind != Insult::teleport; ++i) {
    if (state.inverse_mass[i] == 0) continue;
    if (kind == Insult::noise) {
      Vec3d v = random.vector(1);
      while (v.norm() > 1 || v.norm() < 1e-3) v = random.vector(1);
      state.v[i] = (v.normalized() * 20).template cast<Real>();
    } else {
      state.x[i] = (Vec3d(0.5, -0.5, 0) + random.vector(5e-4)).template cast<Real>();
    }
  }
  if (kind == Insult::teleport) {
    const auto first = state.x.front();
    state.x.front()[2] += Real(3);
    world.accept_state();
    for (int tick = 0; tick < 6; ++tick) rescues += world.step().divergence ? 1 : 0;
    state.x.front() = first;
  }
  world.accept_state();
  return rescues;
}

}  // namespace weft::test
