#include <string>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/allocations.h"
#include "tests/support/worlds.h"

// Strips that are pinned and released while the world runs: what they cost, and whom they concern.

using namespace weft;

namespace {

ClothDef hinged_cloth() {
  ClothDef cloth = test::flat_cloth(9, 9);
  cloth.bending_model = BendingModel::hinges;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = 1e-3;
  return cloth;
}

/// @param hinges  of the cloths but for the first, which always has them
WorldDef world_of(std::size_t cloths, bool hinges) {
  WorldDef def = test::empty_world(hinged_cloth());
  while (def.cloths.size() < cloths) {
    def.cloths.push_back(hinges ? hinged_cloth() : test::flat_cloth(9, 9));
    def.cloths.back().name = "other" + std::to_string(def.cloths.size());
    def.cloths.back().origin = Vec3d(0, static_cast<double>(def.cloths.size()), 0);
  }
  return def;
}

std::size_t allocations_of_a_strip(std::size_t cloths) {
  World<float> world(world_of(cloths, false));
  const std::size_t before = test::count_allocations();
  world.pin({EdgeStrip{Side::top, 0.2}, 0, "cloth"});
  return test::count_allocations() - before;
}

/// The longest damping of bending that a world may have, as a refusal tells it [s].
double longest_damping(WorldDef def) {
  def.cloths[0].fabric.bending_damping = 10;
  try {
    const World<float> refused(def);
  } catch (const DefinitionError& error) {
    return std::stod(error.limit.substr(std::string("at most ").size()));
  }
  return 0;
}

}  // namespace

TEST_CASE("pinning a strip of one cloth weaves no other one anew") {
  const std::size_t before = test::count_allocations();
  const ClothModel<float> other = build_cloth<float>(test::flat_cloth(9, 9));
  const std::size_t weaving = test::count_allocations() - before;
  REQUIRE(weaving > 20);
  constexpr std::size_t kOthers = 8;
  const std::size_t alone = allocations_of_a_strip(1), among = allocations_of_a_strip(1 + kOthers);
  CHECK(among - alone < kOthers * weaving / 2);
}

TEST_CASE("a strip of one cloth stiffens its own hinges alone, and gives them back to the bit") {
  World<double> world(world_of(3, true)), untouched(world_of(3, true));
  const PinId strip = world.pin({EdgeStrip{Side::top, 0.2}, 0, "other2"});
  const auto stiffened = [&](std::size_t part) {
    int count = 0;
    const IndexRange hinges = world.model().parts[part].hinges;
    for (Index n = hinges.first; n < hinges.end(); ++n) {
      const auto k = static_cast<std::size_t>(n);
      count += world.model().hinges[k].stiffness != untouched.model().hinges[k].stiffness;
    }
    return count;
  };
  CHECK(stiffened(0) == 0);
  CHECK(stiffened(1) >= 8);
  CHECK(stiffened(2) == 0);
  world.unpin(strip);
  for (std::size_t part = 0; part < 3; ++part) CHECK(stiffened(part) == 0);
}

TEST_CASE(
    "a pin whose clamp is too stiff for the damping is refused live as at load, and nothing else") {
  WorldDef def = test::empty_world(test::flat_cloth(41, 41, 0.2, 0.2));
  FabricDef& fabric = def.cloths[0].fabric;
  fabric.bending_warp = fabric.bending_weft = 1e-3;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.pins = {{MaterialPoint{0, 0}, 0, {}}};
  fabric.bending_damping = longest_damping(def);
  World<float> world(def), other(def);
  const PinDef disc{MaterialPoint{0.5, 0.5}, 0.0222, {}};
  WorldDef with_disc = def;
  with_disc.pins.push_back(disc);
  REQUIRE_THROWS_AS(World<float>(with_disc), DefinitionError);
  for (int tick = 0; tick < 10; ++tick) {
    world.step();
    other.step();
  }
  CHECK_THROWS_AS(world.pin(disc), DefinitionError);
  CHECK(world.pins().list.size() == 1);
  for (int tick = 0; tick < 5; ++tick) {
    world.step();
    other.step();
  }
  CHECK(world.state().x == other.state().x);
}

TEST_CASE("the longest bending damping that a refusal tells is taken") {
  WorldDef def = test::empty_world(test::flat_cloth(41, 41, 0.2, 0.2));
  FabricDef& fabric = def.cloths[0].fabric;
  fabric.bending_warp = fabric.bending_weft = 1e-3;
  fabric.bending_damping = longest_damping(def);
  CHECK(fabric.bending_damping > 1e-3);
  CHECK_NOTHROW(World<float>(def));
}
