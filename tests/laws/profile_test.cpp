#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

// The profile counts work. What cannot matter is not done, so its count is exactly 0; and what
// counts 0 can be switched off without changing one bit of the state.

using namespace weft;

namespace {

/// A cloth that falls past a sphere that it never comes near.
WorldDef falling_cloth() {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9));
  def.cloths[0].origin = Vec3d(0, 3, 0);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.air_density = 1.225;
  def.colliders = {{"sphere", SphereDef{Vec3d(30, 0, 0), 1}}};
  def.pins = {{0, 0.1}};
  return def;
}

/// A cloth that has come to lie on the ground.
WorldDef lying_cloth() {
  WorldDef def = test::empty_world(test::flat_cloth(9, 9));
  def.cloths[0].origin = Vec3d(0, def.cloths[0].fabric.thickness, 0);
  def.environment.gravity = Vec3d(1, -9.81, 0);
  def.colliders = {{"ground", PlaneDef{}}};
  return def;
}

struct Run {
  Profile work;  ///< summed
  std::uint64_t hash = 0;
};

Run run(const WorldDef& def, int ticks = 30) {
  World<float> world(def);
  Run result;
  for (int tick = 0; tick < ticks; ++tick) {
    const TickReport& report = world.step();
    for (std::size_t k = 0; k < kStageCount; ++k)
      result.work.stages[k].work += report.profile.stages[k].work;
  }
  result.hash = world.hash();
  return result;
}

}  // namespace

TEST_CASE("without wind no air is evaluated, and a vacuum has the same bits") {
  WorldDef def = falling_cloth();
  const Run still = run(def);
  CHECK(still.work[Stage::air].work == 0);
  CHECK(still.work[Stage::stretch].work > 0);
  def.environment.air_density = 0;
  CHECK(run(def).hash == still.hash);
  def.environment.air_density = 1.225;
  def.environment.wind = Vec3d(1, 0, 0);
  const Run windy = run(def);
  CHECK(windy.work[Stage::air].work > 0);
  CHECK(windy.hash != still.hash);
}

TEST_CASE("a grid that is flat at rest has no hinge: its bending is the quadratic form's alone") {
  WorldDef def = falling_cloth();
  World<float> flat(def);
  CHECK(flat.model().hinges.empty());
  // 7 second differences in each of 9 rows and columns and 64 twists, for each evaluation.
  const TickReport& report = flat.step();
  const std::uint64_t evaluations =
      report.profile[Stage::stretch].work / flat.model().springs.size();
  CHECK(report.profile[Stage::bending].work == evaluations * (2 * 9 * 7 + 64));
  def.cloths[0].outline = Outline::ellipse;
  World<float> round(def);
  CHECK(round.model().hinges.empty());
  CHECK(round.step().profile[Stage::bending].work > 0);
  def.cloths[0].outline = Outline::rectangle;
  def.cloths[0].rest_angle = 0.1;
  World<float> bent(def);
  CHECK(bent.model().hinges.size() > 0);
  CHECK(bent.step().profile[Stage::bending].work % bent.model().hinges.size() == 0);
}

TEST_CASE("on a flat grid no hinge angle is evaluated, and hinges switched off change no bit") {
  WorldDef def = falling_cloth();
  REQUIRE(def.cloths[0].rest_angle == 0);
  const World<float> flat(def);
  CHECK(flat.model().hinges.empty());
  const Run automatic = run(def);
  def.cloths[0].bending_model = BendingModel::quadratic;
  CHECK(run(def).hash == automatic.hash);
  // Hinges, asked for by name, are counted and are another computation.
  def.cloths[0].bending_model = BendingModel::hinges;
  const World<float> hinged(def);
  const Run bent = run(def);
  CHECK(hinged.model().hinges.size() > 0);
  CHECK(bent.work[Stage::bending].work % hinged.model().hinges.size() == 0);
  CHECK(bent.work[Stage::bending].work != automatic.work[Stage::bending].work);
  CHECK(bent.hash != automatic.hash);
}

TEST_CASE("a cloth without rigidity counts no bending, in whatever way it would be computed") {
  WorldDef def = falling_cloth();
  def.cloths[0].fabric.bending_warp = def.cloths[0].fabric.bending_weft = 0;
  const Run automatic = run(def);
  CHECK(automatic.work[Stage::bending].work == 0);
  def.cloths[0].bending_model = BendingModel::quadratic;
  CHECK(run(def).hash == automatic.hash);
}

TEST_CASE("an object out of reach costs no closest point and no contact, and can be taken away") {
  WorldDef def = falling_cloth();
  const Run far = run(def);
  CHECK(far.work[Stage::narrow_phase].work == 0);
  CHECK(far.work[Stage::contact].work == 0);
  CHECK(far.work[Stage::friction].work == 0);
  def.colliders.clear();
  CHECK(run(def).hash == far.hash);
  def.colliders = {{"sphere", SphereDef{Vec3d(0.5, 2, 0.5), 0.9}}};
  CHECK(run(def).work[Stage::narrow_phase].work > 0);
}

TEST_CASE("a frictionless contact counts no friction") {
  WorldDef def = lying_cloth();
  const Run rough = run(def);
  CHECK(rough.work[Stage::contact].work > 0);
  CHECK(rough.work[Stage::friction].work > 0);
  def.cloths[0].fabric.friction = 0;
  const Run slick = run(def);
  CHECK(slick.work[Stage::contact].work > 0);
  CHECK(slick.work[Stage::friction].work == 0);
  CHECK(slick.hash != rough.hash);
}

TEST_CASE("where nothing touches, friction switched off changes no bit and none is evaluated") {
  WorldDef def = falling_cloth();
  REQUIRE(def.cloths[0].fabric.friction > 0);
  const Run rough = run(def);
  CHECK(rough.work[Stage::friction].work == 0);
  def.cloths[0].fabric.friction = 0;
  const Run slick = run(def);
  CHECK(slick.work[Stage::friction].work == 0);
  CHECK(slick.hash == rough.hash);
}

TEST_CASE("a cloth that stays flat tests no feature against its own, and needs no guard") {
  WorldDef def = falling_cloth();
  def.pins.clear();
  def.contact.seed.self = SelfContact::guard;
  const Run guarded = run(def);
  CHECK(guarded.work[Stage::pairs].work == 0);
  CHECK(guarded.work[Stage::contact].work == 0);
  def.contact.seed.self = SelfContact::none;
  CHECK(run(def).hash == guarded.hash);
}

TEST_CASE("no hand counts no hand, and one that was let go leaves nothing to compute") {
  World<float> world(falling_cloth());
  CHECK(world.step().profile[Stage::attachments].work == 0);
  const GrabId hand = world.grab({20, {0.2, 0.3, 0.5}, 0.1, 100, 50, Vec3d(0.5, 3.5, 0.3)});
  CHECK(world.step().profile[Stage::attachments].work > 0);
  REQUIRE(world.release(hand));
  CHECK(world.step().profile[Stage::attachments].work == 0);
}

TEST_CASE("the time of a stage within another one is its own alone") {
  static double now;
  now = 0;
  Profile profile;
  profile.clock = [] { return now; };
  {
    const StageTimer outer(profile, Stage::contact, 0);
    now += 1;
    {
      const StageTimer inner(profile, Stage::regions, 0);
      now += 10;
      {
        const StageTimer innermost(profile, Stage::pairs, 0);
        now += 100;
      }
      now += 20;
    }
    now += 2;
  }
  CHECK(profile[Stage::contact].seconds == 3);
  CHECK(profile[Stage::regions].seconds == 30);
  CHECK(profile[Stage::pairs].seconds == 100);
  CHECK(profile.running == nullptr);
}
