#include "core/cloth/fabric_presets.h"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"

using namespace weft;

TEST_CASE("every preset makes a cloth of square and of 2:1 cells") {
  for (const FabricPreset& preset : fabric_presets()) {
    INFO(preset.name);
    for (const int columns : {11, 21}) {
      WorldDef def;
      def.cloths[0] = test::flat_cloth(11, columns);
      set_field(def, "fabric", preset.name);
      CHECK(fabric_name(def.cloths[0].fabric) == preset.name);
      CHECK_NOTHROW(World<float>(def));
    }
  }
}

TEST_CASE("measured values are those of their source") {
  // Penava 2014: E t = 0.821 MPa x 0.318 mm and 0.170 MPa x 0.568 mm.
  CHECK(make_fabric("cotton").stretch_warp == Approx(261.08).epsilon(1e-4));
  CHECK(make_fabric("wool").stretch_weft == Approx(96.56).epsilon(1e-4));
  CHECK(make_fabric("cotton").areal_density == 0.1503);
  CHECK(make_fabric("wool").areal_density == 0.2348);
}

TEST_CASE("nylon bends no more easily than its filaments do if they slide freely") {
  constexpr double kDensity = 1140, kModulus = 2.2e9;  // [kg/m^3], the least of textile nylon [Pa]
  constexpr double kFilament = 2.0 / 9e6;              // 2 denier, finer than flags have [kg/m]
  const FabricDef f = make_fabric("nylon");
  const double filaments = f.areal_density / 2 / kFilament;  // [1/m]
  const double area = kFilament / kDensity;
  const double moment = area * area / (4 * std::numbers::pi);
  CHECK(f.bending_warp >= filaments * kModulus * moment);
}

TEST_CASE("stiffer drape has the longer bending length, in the published order") {
  // Published drape coefficients: silk 35 < wool 62 < leather 68 = cotton 70 < denim 87.
  const auto bending_length = [](const char* name) {
    const FabricDef f = make_fabric(name);
    return std::cbrt(f.bending_warp / (9.81 * f.areal_density));
  };
  CHECK(bending_length("silk") < bending_length("wool"));
  CHECK(bending_length("wool") < bending_length("cotton"));
  CHECK(bending_length("wool") < bending_length("leather"));
  CHECK(bending_length("cotton") < bending_length("denim"));
  CHECK(bending_length("leather") < bending_length("denim"));
}

TEST_CASE("a fabric's name follows its values") {
  FabricDef fabric;
  CHECK(fabric_name(fabric) == "default");
  fabric = make_fabric("denim");
  CHECK(fabric_name(fabric) == "denim");
  fabric.friction = 0.1;
  CHECK(fabric_name(fabric) == "custom");
}

TEST_CASE("presets are set for each cloth, and an unknown one is refused with all names") {
  WorldDef def;
  def.cloths.push_back(ClothDef{});
  set_field(def, "cloths[1].fabric", "silk");
  CHECK(fabric_name(def.cloths[0].fabric) == "default");
  CHECK(fabric_name(def.cloths[1].fabric) == "silk");
  set_field(def, "cloths[0].fabric", "wool");
  CHECK(fabric_name(def.cloths[0].fabric) == "wool");
  try {
    set_field(def, "fabric", "paper");
    FAIL("accepted");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "fabric");
    CHECK(error.limit.find("denim") != std::string::npos);
  }
}
