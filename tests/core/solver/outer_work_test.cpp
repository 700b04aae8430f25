#include <catch2/catch.hpp>

#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// The work that a tick of verlet tells, which decides whether its energy has a source.

using namespace weft;

namespace {

/// A free cloth without dashpots or drag, in wind: a grid that steps by rows, one whose dashpots
/// are swept twice, one with contact among its layers, and a mesh.
WorldDef blown(int way) {
  ClothDef cloth = test::flat_cloth(8, 8, 0.5, 0.5);
  if (way == 3) cloth = test::triangle_sheet(test::Cut::irregular, 0.5, 0.5, 0.07);
  cloth.fabric.damping_ratio = 0;
  WorldDef def = test::empty_world(cloth);
  def.environment.air_density = 1.225;
  def.environment.wind = Vec3d(1, 4, 3);
  def.solver.min_substeps = 30;
  if (way == 1) def.solver.damping_sweeps = 2;
  if (way == 2) def.contact.seed.self = SelfContact::guard;
  return def;
}

}  // namespace

TEST_CASE("the work told of air and slings is what a cloth without losses gains, to 0.5 %") {
  const int way = GENERATE(0, 1, 2, 3);
  const bool sling = GENERATE(false, true);
  CAPTURE(way, sling);
  WorldDef def = blown(way);
  if (sling) def.environment.wind.setZero();
  World<double> world(def);
  if (sling) {
    GrabDef hold;
    hold.mode = GrabMode::sling;
    hold.radius = 2;  // all of the cloth, so that nothing folds and meets
    hold.stiffness = 5;
    hold.target = world.state().x[0] + Vec3d(0.1, 0.3, 0);
    REQUIRE(world.fire(world.grab(hold)));
  }
  const double start = world.report().energies.total();
  double work = 0;
  for (int tick = 0; tick < 20; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    work += world.report().work;
  }
  const double gained = world.report().energies.total() - start;
  CHECK(gained > 0.01);
  CHECK(work == Approx(gained).epsilon(5e-3));
}
