#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/world/crossing_counter.h"
#include "core/world/world.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"

namespace weft::test {

// Hands that take hold of a cloth anywhere, pull it about and let go, and an exact count of what
// passed through what after each tick.

/// From how much to how much of something.
struct Span {
  double least, most;
};

/// What hands can do.
struct Strength {
  Span stiffness = {100, 2000};  ///< [N/m]
  Span max_force = {2, 50};      ///< [N]
  Span speed = {0.5, 5};         ///< [m/s]
};

/// The strongest hands that a viewer may have.
inline constexpr Strength kGiant = {{1e5, 1e5}, {1e6, 1e6}, {20, 20}};

/// A hand that moves through points at random, each reached at a speed of its own.
class WanderingHand {
 public:
  /// Takes hold of a random point of a random triangle.
  WanderingHand(World<float>& world, Random& random, const Strength& strength)
      : speeds_(strength.speed) {
    GrabDef def;
    def.triangle = random.index(static_cast<Index>(world.model().triangles.size()));
    double a = random.uniform(0, 1), b = random.uniform(0, 1);
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    def.barycentric = {1 - a - b, a, b};
    def.radius = random.uniform(0, 1) < 0.2 ? 0 : random.uniform(0.01, 0.08);
    def.stiffness = random.uniform(strength.stiffness.least, strength.stiffness.most);
    def.max_force = random.uniform(strength.max_force.least, strength.max_force.most);
    const Triangle& t = world.model().triangles[static_cast<std::size_t>(def.triangle)];
    for (std::size_t k = 0; k < 3; ++k)
      at_ += def.barycentric[k] * world.state().x[static_cast<std::size_t>(t[k])].cast<double>();
    def.target = at_;
    id_ = world.grab(def);
    first_ = static_cast<int>(random.index(6));
    last_ = first_ + 8 + static_cast<int>(random.index(25));
    turn(random);
  }

  /// Before each tick of a drag, which is counted from 0.
  /// @returns whether it still holds
  bool move(int tick, World<float>& world, Random& random) {
    if (tick > last_) {
      if (id_ != 0) world.release(id_);
      id_ = 0;
      return false;
    }
    if (tick < first_) return true;
    double step = speed_ * world.tick_seconds();
    if ((goal_ - at_).norm() <= step) turn(random);
    step = std::min(speed_ * world.tick_seconds(), (goal_ - at_).norm());
    if (step > 0) at_ += (goal_ - at_).normalized() * step;
    world.move_grab(id_, at_);
    return true;
  }

 private:
  /// The objects are around the middle, the ground is at 0: as often as not the path is barred.
  void turn(Random& random) {
    goal_ = Vec3d(random.uniform(-0.7, 0.7), random.uniform(-0.2, 1), random.uniform(-0.7, 0.7));
    speed_ = random.uniform(speeds_.least, speeds_.most);
  }

  GrabId id_ = 0;
  int first_ = 0, last_ = 0;
  Span speeds_;
  double speed_ = 0;  ///< [m/s]
  Vec3d at_ = Vec3d::Zero(), goal_ = Vec3d::Zero();
};

/// What was seen while hands dragged.
struct DragFigures {
  std::size_t crossings = 0;
  int crossed_ticks = 0, first_tick = -1, ticks = 0, blow_ups = 0;
  double deepest = 0, strain = 0, lost = 0;

  void look(const World<float>& world, CrossingCounter<float>& counter) {
    const std::size_t found = counter.count(world).total();
    crossings += found;
    if (found > 0 && first_tick < 0) first_tick = static_cast<int>(world.tick());
    crossed_ticks += found > 0 ? 1 : 0;
    ++ticks;
    blow_ups += world.report().divergence ? 1 : 0;
    deepest = std::max(deepest, world.deepest_penetration());
    strain = std::max(strain, world.report().largest_strain);
    lost = lost_fraction(world);
  }
};

/// Lets the scene come down, then one to ten hands at a time drag its cloth, `drags` times.
inline DragFigures drag_about(const WorldDef& def, int settle_ticks, int drags, unsigned seed,
                              const Strength& strength = {}) {
  constexpr Index kMostHands = 10;
  constexpr int kPause = 6;
  Random random(seed);
  World<float> world(def);
  for (Vec3f& v : world.state().v) v += random.vector(0.05).cast<float>();
  world.accept_state();
  CrossingCounter<float> counter;
  DragFigures figures;
  for (int tick = 0; tick < settle_ticks; ++tick) {
    world.step();
    figures.look(world, counter);
  }
  for (int drag = 0; drag < drags; ++drag) {
    std::vector<WanderingHand> hands;
    for (Index k = 1 + random.index(kMostHands); k > 0; --k)
      hands.emplace_back(world, random, strength);
    int idle = 0;
    for (int tick = 0; idle < kPause; ++tick) {
      bool held = false;
      for (WanderingHand& hand : hands) held = hand.move(tick, world, random) || held;
      idle += held ? 0 : 1;
      world.step();
      figures.look(world, counter);
    }
  }
  return figures;
}

}  // namespace weft::test
