#include "core/solver/held_forces.h"

#include <algorithm>
#include <limits>

#include <catch2/catch.hpp>

#include "core/solver/verlet.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

using namespace weft;
using test::SeededRandom;

namespace {

/// Every kind of element of a grid, and of an irregular mesh.
std::vector<ClothDef> sheets() {
  std::vector<ClothDef> all(4, test::flat_cloth(9, 8, 1, 0.8));
  all[1].bending_model = BendingModel::hinges;
  all[2].fabric.locking_strain = 0.01;
  all[3] = test::triangle_sheet(test::Cut::irregular, 1, 0.8, 0.1);
  return all;
}

}  // namespace

TEST_CASE("the forces of pins depend on no particle but those that are seen, few of all") {
  SeededRandom random(3);
  for (const ClothDef& sheet : sheets()) {
    WorldDef def = test::empty_world(sheet);
    def.pins = {{0, 0, {}}, {7, 0, {}}};
    const World<double> world(def);
    ClothState<double> state = world.state();
    Surroundings<double> around;
    around.air = true;
    around.air_density = 1.2;
    for (std::size_t i = 0; i < state.x.size(); ++i) {
      state.x[i] += random.vector(0.01);
      state.v[i] = random.vector(1);
      around.wind.push_back(random.vector(5));
    }
    HeldForces<double> held;
    const auto impulse = [&] {
      held.begin_tick(world.model(), world.pins());
      held.act(around, state.x, state.v, 0.01);
      return Vec3d(held.impulse(0));
    };
    const Vec3d all = impulse();
    CHECK(all.norm() > 0);
    const std::vector<Index>& seen = held.seen(0);
    CHECK(std::is_sorted(seen.begin(), seen.end()));
    CHECK(2 * seen.size() < state.x.size());
    for (std::size_t i = 0; i < state.x.size(); ++i) {
      if (std::binary_search(seen.begin(), seen.end(), static_cast<Index>(i))) continue;
      state.x[i].setConstant(std::numeric_limits<double>::quiet_NaN());
      state.v[i] = state.x[i];
    }
    CHECK(impulse() == all);
  }
}
