#include <array>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/crossing_counter.h"
#include "tests/core/contact/drags.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets.h"
#include "tests/support/worlds.h"

// How far the guard's promise reaches: with every solver, and as far from the origin as a cloth may
// start.

using namespace weft;
using namespace weft::test;

namespace {

/// A solver and how it is set.
struct Setting {
  const char* name;
  SolverKind kind;
  RelaxationDef relaxation = {};
  /// Part of the wanted motion that the guard may take from hands. Provot's single substep wants to
  /// go the 8 cm of a hand's tick at once, through whatever layers are there.
  double lost_to_hands = 0.2;
};

/// Provot's sweeps over rigid springs, and XPBD with the fabric's compliance in small substeps.
const std::array<Setting, 4> kSettings = {{{"verlet", SolverKind::verlet},
                                           {"Provot", SolverKind::relaxation, {}, 0.3},
                                           {"XPBD", SolverKind::relaxation, {4, 8, 0.002, 1}},
                                           {"implicit", SolverKind::implicit}}};

/// A small scene, and how far its cloth must come down in the mean so that it was not frozen [m].
struct Miniature {
  const char* name;
  WorldDef def;
  double fall;
  double noise = 0.05;  ///< of velocities at the start [m/s]
};

WorldDef scene(const char* name, int particles) {
  WorldDef def = make_scene(name, "");
  for (ClothDef& cloth : def.cloths) cloth.rows = cloth.columns = particles;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

WorldDef small_sheet() {
  WorldDef def = empty_world(flat_cloth(14, 14, 0.4, 0.4));
  def.cloths[0].fabric.thickness = 0.008;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

std::array<Miniature, 6> miniatures() {
  return {{{"crumpling sheet", upright_sheet(14, 0.6, 0.75, 0.25, 0.2), 0.2},
           {"noise of 20 m/s", small_sheet(), -1, 20},
           {"drape-sphere", scene("drape-sphere", 17), 0.05},
           {"table", scene("table", 17), 0.02},
           {"hard-needles", scene("hard-needles", 17), 0.02},
           {"hard-knives", scene("hard-knives", 17), 0.02}}};
}

/// What a run showed.
struct Seen {
  std::size_t crossings = 0;
  double deepest = 0;  ///< [m]
  double path = 0;     ///< of the mean particle, added up over ticks [m]
  double fall = 0;     ///< of the mean particle [m]
  double lost = 0;     ///< part of the wanted motion
  int blow_ups = 0;
};

template <class Real>
Seen watch(World<Real>& world, int ticks) {
  Seen seen;
  CrossingCounter<Real> counter;
  const auto count = static_cast<double>(world.state().x.size());
  for (int tick = 0; tick < ticks; ++tick) {
    const Vec3Array<Real> before = world.state().x;
    seen.blow_ups += world.step().divergence ? 1 : 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vec3d way = (world.state().x[i] - before[i]).template cast<double>();
      seen.path += way.norm() / count;
      seen.fall -= way[1] / count;
    }
    seen.crossings += counter.count(world).total();
    seen.deepest = std::max(seen.deepest, world.deepest_penetration());
  }
  seen.lost = lost_fraction(world);
  return seen;
}

}  // namespace

TEST_CASE("with every solver the guard leaves no crossing at any tick, and does not freeze") {
  for (const Setting& setting : kSettings) {
    for (Miniature& scene : miniatures()) {
      scene.def.solver.kind = setting.kind;
      scene.def.relaxation = setting.relaxation;
      World<float> world(scene.def);
      REQUIRE(world.guard() != nullptr);
      jolt(world, scene.noise, 5);
      const Seen seen = watch(world, 90);
      INFO(setting.name << ", " << scene.name << ": lost " << seen.lost << ", path " << seen.path
                        << " m, fall " << seen.fall << " m");
      CHECK(seen.crossings == 0);
      CHECK(seen.deepest == 0);
      CHECK(seen.blow_ups == 0);
      CHECK(seen.lost < 0.2);
      CHECK(seen.fall >= scene.fall);
      CHECK(seen.path > 0.05);
    }
  }
}

TEST_CASE("with every solver ten hands at up to 5 m/s drag a pile without a crossing") {
  for (const Setting& setting : kSettings) {
    for (const unsigned seed : seeds(1, 2)) {
      const Repeatable repeatable(seed);
      WorldDef def = upright_sheet(15, 0.6, 0.65, 0.25, 0.5);
      def.solver.kind = setting.kind;
      def.relaxation = setting.relaxation;
      const DragFigures seen = drag_about(def, 40, 2, seed);
      INFO(setting.name << ": " << seen.ticks << " ticks, first crossing " << seen.first_tick
                        << ", lost " << seen.lost << ", inside " << seen.deepest);
      CHECK(seen.crossings == 0);
      CHECK(seen.deepest == 0);
      CHECK(seen.blow_ups == 0);
      CHECK(seen.lost < setting.lost_to_hands);
    }
  }
}

namespace {

/// A sheet that crumples on ground that lies there.
template <class Real>
void check_crumples_at(const Vec3d& place) {
  WorldDef def = upright_sheet(14, 0.6, 0.75, 0.25, 0.2);
  def.cloths[0].origin += place;
  PlaneDef ground;
  ground.point = place;
  def.colliders = {{"ground", ground}};
  World<Real> world(def);
  jolt(world, 0.05, 6);
  const Seen seen = watch(world, 90);
  INFO("at " << place.transpose() << ", lost " << seen.lost << ", fall " << seen.fall << " m");
  CHECK(seen.crossings == 0);
  CHECK(seen.blow_ups == 0);
  CHECK(world.guard()->counts().anchored > 100);  // it met itself
  CHECK(seen.lost < 0.2);
  CHECK(seen.fall > 0.2);
}

}  // namespace

// Provot's relaxation brings the strain of a jump back in one step: particles wish to go much
// farther than the gaps about them, and who is stopped leaves the path that others were told of.
TEST_CASE("who is stopped far off his path is crossed by nobody who was let go on") {
  const auto [name, ticks] = GENERATE(table<std::string, int>(
      {{"hard-far-teleport", 240}, {"hard-step-30th", 150}, {"hard-teleport", 270}}));
  CAPTURE(name);
  WorldDef def = make_scene(name);
  def.solver.kind = SolverKind::relaxation;
  World<float> world(def);
  CrossingCounter<float> counter;
  for (int tick = 1; tick <= ticks; ++tick) {
    world.step();
    CAPTURE(tick);
    REQUIRE(counter.count(world).total() == 0);
  }
}

TEST_CASE("up to 99 m from the origin a crumpling sheet crosses itself at no tick, and moves") {
  for (const unsigned seed : seeds(1, 4)) {
    const Repeatable repeatable(seed);
    Random random(seed);
    const Vec3d place = random.vector(1).normalized() * std::pow(10, random.uniform(1, 2)) * 0.99;
    check_crumples_at<float>(place);
    check_crumples_at<double>(place);
  }
}
