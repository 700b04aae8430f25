#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/diagnostics/crossings.h"
#include "core/scenes/scenes.h"
#include "tests/support/folds.h"

// The figures of the seed that compare two ways, each as a pair of built-in scenes and a number
// that tells them apart.

using namespace weft;
using namespace weft::test;

namespace {

Crossings self_crossings(const World<float>& world) {
  return count_self_crossings(world.state().x, world.model().edges, world.model().triangles);
}

/// A mesh that a scene has, by its name.
const TriangleMesh& mesh_of(const World<float>& world, const std::string& name) {
  for (const ColliderDef& object : world.def().colliders) {
    if (object.name == name) return std::get<MeshDef>(object.shape).mesh;
  }
  throw std::runtime_error("no object " + name);
}

}  // namespace

TEST_CASE("Fig. 4: a rest angle of 15 degrees makes round folds of the wrinkles of no bending") {
  World<float> none(make_scene("seed-fig4-no-bending"));
  World<float> folded(make_scene("seed-fig4-rest-angle"));
  step(none, 65);
  step(folded, 65);
  const Folds without = measure_folds(none), with = measure_folds(folded);
  CAPTURE(without.mean, with.mean, without.sharp, with.sharp);
  CHECK(with.mean < 0.7 * without.mean);
  CHECK(with.sharp < 0.5 * without.sharp);
}

TEST_CASE("Fig. 4: it is the rest angle that curls the cloth, to the side of its sign", "[.long]") {
  const auto twist = [](double rest_angle) {
    WorldDef def = make_scene("seed-fig4-rest-angle");
    CHECK(def.cloths[0].rest_angle == Approx(0.2617994));  // 15 degrees
    def.cloths[0].rest_angle = rest_angle;
    World<float> world(def);
    step(world, 100);
    return measure_folds(world).twist;
  };
  const double down = twist(0.2617994), flat = twist(0), up = twist(-0.2617994);
  CAPTURE(down, flat, up);
  CHECK(down > flat + 0.008);
  CHECK(up < flat - 0.003);
}

TEST_CASE("Fig. 8: projection lays folds flat on the ground, the map of distances keeps them") {
  const auto height_of_folds = [](const char* scene, double& flat) {
    World<float> world(make_scene(scene));
    step(world, 50);
    const double lift = world.def().contact.seed.lift;
    double sum = 0, count = 0, lying = 0;
    for (const Vec3f& x : world.state().x) {
      if (std::hypot(x[0], x[2]) < 0.3) continue;  // on the ball, or hanging from it
      sum += x[1] - lift;
      lying += x[1] < lift + 5e-4 ? 1 : 0;
      ++count;
    }
    flat = lying / count;
    return sum / count;
  };
  double flat_by_projection = 0, flat_by_map = 0;
  const double projected = height_of_folds("seed-fig8-projection", flat_by_projection);
  const double mapped = height_of_folds("seed-fig8-fold-map", flat_by_map);
  CAPTURE(projected, mapped, flat_by_projection, flat_by_map);
  CHECK(mapped > 1.3 * projected);
  CHECK(flat_by_map < 0.3 * flat_by_projection);
}

TEST_CASE("Fig. 10, V.B.1: a sharp ridge cuts through particles alone, and not through edges") {
  World<float> particles(make_scene("seed-fig10-sharp-edge"));
  World<float> edges(make_scene("seed-fig10-edge-pairs"));
  std::size_t cut = 0, held = 0;
  for (int n = 0; n < 12; ++n) {
    step(particles, 10);
    step(edges, 10);
    for (const auto& [world, sum] : {std::pair(&particles, &cut), std::pair(&edges, &held)}) {
      *sum += count_crossings(world->state().x, world->model().edges, world->model().triangles,
                              mesh_of(*world, "gable"))
                  .proper;
    }
  }
  CAPTURE(cut, held);
  CHECK(cut > 100);
  CHECK(held < cut / 10);
}

TEST_CASE("Figs. 11, 12, V.B.2, V.B.3: particle pairs let folds through, triangle pairs do not") {
  World<float> particles(make_scene("seed-fig11-particle-pairs"));
  World<float> triangles(make_scene("seed-fig12-triangle-pairs"));
  std::size_t through = 0, held = 0;
  std::uint64_t particle_tests = 0, triangle_tests = 0;
  for (int n = 0; n < 9; ++n) {
    for (int tick = 0; tick < 10; ++tick) {
      particle_tests += particles.step().profile[Stage::narrow_phase].work;
      triangle_tests += triangles.step().profile[Stage::narrow_phase].work;
    }
    through += self_crossings(particles).proper;
    held += self_crossings(triangles).proper;
  }
  CAPTURE(through, held, particle_tests, triangle_tests);
  CHECK(through > 100);
  CHECK(held == 0);
  // What it costs: so many times the pairs.
  CHECK(triangle_tests > 2 * particle_tests);
}
