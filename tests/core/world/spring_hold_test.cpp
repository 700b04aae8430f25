#include "core/world/spring_hold.h"

#include <catch2/catch.hpp>

#include "tests/support/worlds.h"

using namespace weft;

namespace {

struct Case {
  int rows = 25, substeps = 1, sweeps = 1;
  double compliance = 1;
};

/// A cloth of a metre that hangs by its upper edge, with contact of cloth with cloth.
WorldDef hanging_sheet(const Case& c) {
  ClothDef cloth = test::flat_cloth(c.rows, c.rows / 2 + 1);
  cloth.width = 0.5;
  cloth.height = 1;
  cloth.u = Vec3d::UnitX();
  cloth.v = -Vec3d::UnitY();
  cloth.fabric = FabricDef{};
  WorldDef def = test::empty_world(cloth);
  def.contact.seed.self = SelfContact::automatic;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.substeps = c.substeps;
  def.relaxation.sweeps = c.sweeps;
  def.relaxation.compliance = c.compliance;
  def.pins = {{EdgeStrip{Side::top, 0.0}, 0.0, {}}};
  return def;
}

/// Largest strain after a time. Contact of cloth with cloth does not act in a net that hangs, and
/// takes minutes in one that does not.
double strain_after(WorldDef def, double seconds) {
  def.contact.seed.self = SelfContact::none;
  World<float> world(def);
  test::advance(world, seconds);
  return world.report().largest_strain;
}

}  // namespace

TEST_CASE("a net of n springs under relaxation hangs with 3 n g dt^2 / (h sweeps), factor 2") {
  const Case c = GENERATE(Case{25, 8, 1}, Case{25, 16, 1}, Case{25, 4, 4}, Case{49, 16, 1},
                          Case{49, 8, 4}, Case{65, 22, 1}, Case{25, 4, 4, 0}, Case{49, 16, 3, 0});
  const WorldDef def = hanging_sheet(c);
  const double dt = 1 / def.tick_rate / c.substeps;
  const double told =
      strain_of_hanging(c.rows - 1, 1.0 / (c.rows - 1), 9.81, dt, sweeps_taken(def.relaxation));
  const double measured = strain_after(def, 2);
  INFO(c.rows << " rows, " << c.substeps << " x " << c.sweeps << ": " << told);
  CHECK(measured > told / 2);
  CHECK(measured < told * 2);
  CHECK(slack_springs(World<float>(def)).empty());
}

TEST_CASE("springs that are told to be slack are drawn out too far, and held as it is told") {
  const Case c = GENERATE(Case{25, 2, 1}, Case{33, 3, 1}, Case{49, 4, 1}, Case{37, 16, 1, 0});
  const std::vector<SlackSprings> told = slack_springs(World<float>(hanging_sheet(c)));
  REQUIRE(told.size() == 1);
  INFO(describe(told[0]));
  CHECK(told[0].substeps == c.substeps);
  CHECK(strain_after(hanging_sheet(c), 2) > kMostHangingStrain);
  const WorldDef enough =
      hanging_sheet({c.rows, told[0].needed, told[0].needed_sweeps, c.compliance});
  CHECK(slack_springs(World<float>(enough)).empty());
  CHECK(strain_after(enough, 2) < 2 * kMostHangingStrain);
}

TEST_CASE(
    "springs are slack with relaxation beside contact of cloth with cloth and gravity alone") {
  WorldDef def = hanging_sheet({25, 2, 1});
  REQUIRE(slack_springs(World<float>(def)).size() == 1);
  SECTION("another solver") {
    def.solver.kind = SolverKind::verlet;
  }
  SECTION("no contact with itself") {
    def.contact.seed.self = SelfContact::none;
  }
  SECTION("no gravity") {
    def.environment.gravity.setZero();
  }
  SECTION("many sweeps") {
    def.relaxation.sweeps = 1000;
  }
  CHECK(slack_springs(World<float>(def)).empty());
}

TEST_CASE("the substeps that slack springs need are the fewest that hold them") {
  const std::vector<SlackSprings> told = slack_springs(World<float>(hanging_sheet({25, 2, 1})));
  REQUIRE(told.size() == 1);
  CHECK(slack_springs(World<float>(hanging_sheet({25, told[0].needed, 1}))).empty());
  CHECK(slack_springs(World<float>(hanging_sheet({25, told[0].needed - 1, 1}))).size() == 1);
}
