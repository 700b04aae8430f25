#include "core/forces/grid_pass.h"

#include <algorithm>

#include <catch2/catch.hpp>

#include "core/cloth/cloth_model.h"
#include "core/forces/force_pass.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/targets.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

/// Runs chunks one after the other, the last one first.
class Backwards : public Executor {
 public:
  void run(int chunks, void (*work)(void* context, int chunk), void* context) override {
    most_chunks = std::max(most_chunks, chunks);
    for (int chunk = chunks - 1; chunk >= 0; --chunk) work(context, chunk);
  }
  int most_chunks = 0;
};

template <class Real>
struct Moved {
  Vec3Array<Real> x, v;
  double power = 0;
  ElasticEnergy energy;
};

/// A shaken cloth after some substeps in the wind, with two particles pinned.
template <class Real>
Moved<Real> moved(const ClothDef& def, Executor* executor = nullptr) {
  const ClothModel<Real> model = build_cloth<Real>(def);
  Random random(11);
  Moved<Real> cloth;
  cloth.x = test::shaken(model, 0.01, random);
  cloth.v = test::random_velocities(model, 3, random);
  const Vec3Array<Real> wind = test::random_velocities(model, 5, random);
  std::vector<Real> inverse_mass;
  for (const Real mass : model.mass) inverse_mass.push_back(1 / mass);
  inverse_mass[0] = inverse_mass[inverse_mass.size() / 2] = 0;
  GridPass<Real> grid;
  grid.prepare(model.parts[0]);
  grid.allocate_external(true);
  if (executor) grid.allocate_bands();
  grid.load(cloth.x, cloth.v, executor);
  grid.load_inverse_mass(inverse_mass);
  grid.load_wind(wind);
  GridStep<Real> step{Real(0.999), Real(1e-4), {0, Real(-9.81), 1}, Real(1e-4), true};
  for (int k = 0; k < 5; ++k) {
    grid.compute_air_forces(1.225);
    cloth.power += grid.advance(step, executor);
  }
  grid.store(cloth.x, cloth.v, executor);
  cloth.power += grid.drift(Real(1e-4), true, cloth.v, cloth.x, executor);
  cloth.energy = grid.elastic_energy();
  return cloth;
}

/// Some particles of a grid that is stored in part, and in full.
template <class Real>
void check_partial_store(const ClothDef& def) {
  const ClothModel<Real> model = build_cloth<Real>(def);
  Random random(5);
  const Vec3Array<Real> x = test::shaken(model, 0.01, random);
  const Vec3Array<Real> v = test::random_velocities(model, 3, random);
  GridPass<Real> grid;
  grid.prepare(model.parts[0]);
  grid.load(x, v);
  const Vec3Array<Real> nothing(x.size(), Vec3<Real>::Zero());
  Vec3Array<Real> some_x = nothing, some_v = nothing;
  std::vector<Index> chosen;
  for (Index i = 1; i < model.particle_count(); i += 3) chosen.push_back(i);
  grid.store(chosen, some_x, some_v);
  for (std::size_t i = 0; i < x.size(); ++i) {
    CHECK(some_x[i] == (i % 3 == 1 ? x[i] : nothing[i]));
    CHECK(some_v[i] == (i % 3 == 1 ? v[i] : nothing[i]));
  }
}

template <class Real>
void check_all_targets(const ClothDef& def) {
  const Moved<Real> best = moved<Real>(def);
  test::for_each_target([&] {
    const Moved<Real> other = moved<Real>(def);
    CHECK(other.x == best.x);
    CHECK(other.v == best.v);
    CHECK(other.power == best.power);
    CHECK(other.energy.stretch == best.energy.stretch);
    CHECK(other.energy.bending == best.energy.bending);
    CHECK(other.energy.largest_strain == best.energy.largest_strain);
  });
}

}  // namespace

TEST_CASE("every instruction set moves a grid to the same bits") {
  const auto [rows, columns] = GENERATE(table<int, int>({{2, 2}, {3, 17}, {20, 33}}));
  ClothDef def = test::flat_cloth(rows, columns, 1, 0.8);
  def.outline = GENERATE(Outline::rectangle, Outline::ellipse);
  def.fabric.shear = 0.5;
  def.fabric.bending_warp = 2e-3;
  check_all_targets<float>(def);
  check_all_targets<double>(def);
}

TEMPLATE_TEST_CASE("bands of a grid move it to the same bits, whichever comes first", "", float,
                   double) {
  const auto [rows, columns, bands] =
      GENERATE(table<int, int, int>({{31, 300, 1}, {32, 128, 2}, {61, 101, 3}, {300, 60, 4}}));
  ClothDef def = test::flat_cloth(rows, columns, 0.03 * columns, 0.03 * rows);
  def.outline = GENERATE(Outline::rectangle, Outline::ellipse);
  def.fabric.shear = 0.5;
  def.fabric.bending_warp = 2e-3;
  Backwards backwards;
  test::TwoThreads two_threads;
  const Moved<TestType> alone = moved<TestType>(def);
  for (Executor* executor :
       {static_cast<Executor*>(&backwards), static_cast<Executor*>(&two_threads)}) {
    const Moved<TestType> other = moved<TestType>(def, executor);
    CHECK(other.x == alone.x);
    CHECK(other.v == alone.v);
    CHECK(other.power == alone.power);
  }
  CHECK(std::max(1, backwards.most_chunks) == bands);
}

TEMPLATE_TEST_CASE("some particles of a grid are stored as all are, and no others", "", float,
                   double) {
  ClothDef def = test::flat_cloth(7, 19, 1, 0.8);
  def.outline = GENERATE(Outline::rectangle, Outline::ellipse);
  check_partial_store<TestType>(def);
}

TEST_CASE("a pinned particle stays where it is, and what pulls it counts no power") {
  ClothDef def = test::flat_cloth(5, 9);
  const ClothModel<float> model = build_cloth<float>(def);
  SeededRandom random(3);
  Vec3Array<float> x = test::shaken(model, 0.05, random), v(x.size(), Vec3f::Zero()), pull = x;
  const Vec3Array<float> before = x;
  GridPass<float> grid;
  grid.prepare(model.parts[0]);
  grid.allocate_external(false);
  grid.load(x, v);
  grid.load_inverse_mass(std::vector<float>(x.size(), 0));
  grid.load_external(pull);
  CHECK(grid.advance({1, 1, {1, 2, 3}, 1, true}) == 0);
  grid.store(x, v);
  CHECK(x == before);
  CHECK(v == Vec3Array<float>(x.size(), Vec3f::Zero()));
}

TEST_CASE("verlet takes at most 122 bytes a particle of a large grid, until air or hands come") {
  WorldDef def = test::empty_world(test::flat_cloth(128, 128));
  test::TwoThreads two_threads;
  World<float> world(def, {&two_threads, nullptr});
  const double particles = 128 * 128;
  CHECK(static_cast<double>(world.solver_bytes()) <= 122 * particles);
  def.environment = world.environment();
  def.environment.wind = Vec3d(1, 0, 0);
  def.environment.air_density = 1.2;
  world.set_environment(def.environment);
  CHECK(static_cast<double>(world.solver_bytes()) > 122 * particles);
}
