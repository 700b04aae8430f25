#include "core/solver/implicit/implicit.h"

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/support/allocations.h"
#include "tests/support/cloths.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// What the solver implicit promises besides its accuracy, which tests/laws/implicit_test.cpp tests.

using namespace weft;
using namespace weft::test;

TEST_CASE("with implicit a tick allocates nothing, and a world that is reset repeats its bits") {
  WorldDef def = make_scene("curtain");
  def.solver.kind = SolverKind::implicit;
  World<float> world(def);
  world.grab({50, {0.2, 0.3, 0.5}, 0.1, 100, 20, Vec3d(0, 1.5, 0)});
  for (int tick = 0; tick < 30; ++tick) world.step();
  const std::size_t before = count_allocations();
  for (int tick = 0; tick < 10; ++tick) world.step();
  CHECK(count_allocations() == before);
  const auto run = [&world] {
    world.reset();
    for (int tick = 0; tick < 40; ++tick) world.step();
    return world.hash();
  };
  const std::uint64_t once = run();
  CHECK(run() == once);
}

TEST_CASE("with implicit a tick of a small mesh allocates nothing, whose matrix it factors") {
  WorldDef def = empty_world(triangle_sheet(Cut::irregular, 0.3, 0.2, 0.03));
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.solver.kind = SolverKind::implicit;
  def.pins = upper_border(def.cloths[0]);
  World<float> world(def);
  for (int tick = 0; tick < 10; ++tick) world.step();
  const std::size_t before = count_allocations();
  for (int tick = 0; tick < 10; ++tick) world.step();
  CHECK(count_allocations() == before);
}

TEST_CASE("energy that implicit may give back is forgotten by time, not by ticks: alike to 10 %") {
  const ClothModel<double> model = build_cloth<double>(flat_cloth(4, 4));
  const auto left = [&model](int ticks) {
    ImplicitWorkspace<double> work;
    work.prepare(model);
    ClothState<double> state = initial_state(model);
    Grabs<double> grabs;
    Profile profile;
    const auto step = [&] {
      advance_implicit(model, Surroundings<double>{}, ImplicitDef{}, 0.1 / ticks, 1, grabs,
                       Collision<double>{}, state, work, profile);
    };
    step();  // has no past
    work.credit = 1;
    for (int k = 0; k < ticks; ++k) step();
    return work.credit;
  };
  CHECK(left(6) == Approx(0.53).epsilon(0.02));  // 0.9 in each sixtieth of a second
  CHECK(left(100) == Approx(left(6)).epsilon(0.1));
  CHECK(left(3) == Approx(left(6)).epsilon(0.1));
}
