#include "core/solver/bending_dashpots.h"

#include <cmath>
#include <optional>
#include <string>

#include <catch2/catch.hpp>

#include "core/diagnostics/energies.h"
#include "core/error.h"
#include "core/forces/force_pass.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/targets.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

using namespace weft;
using test::SeededRandom;

namespace {

/// A grid and an irregular mesh, with a relaxation time of bending [s].
std::vector<ClothDef> sheets(double time) {
  std::vector<ClothDef> all = {test::flat_cloth(9, 8, 1, 0.8),
                               test::triangle_sheet(test::Cut::irregular, 1, 0.8, 0.1)};
  for (ClothDef& sheet : all) {
    sheet.fabric.bending_warp = sheet.fabric.bending_weft = 1e-2;
    sheet.fabric.bending_damping = time;
  }
  return all;
}

template <class Real>
struct MovingIn {
  ClothModel<Real> model;
  ClothState<Real> state;
  BendingDashpots<Real> dashpots;

  explicit MovingIn(const ClothDef& sheet)
      : model(build_cloth<Real>(sheet)), state(initial_state(model)) {
    dashpots.prepare(model);
  }

  void bend() {
    for (std::size_t i = 0; i < state.x.size(); ++i) {
      const auto& place = model.material[i];
      state.x[i] = Vec3d(std::sin(place[0]), std::cos(place[0]), place[1]).template cast<Real>();
    }
  }
  void shake(SeededRandom& random) {
    state.x = test::shaken(model, 0.001, random);
    for (Vec3<Real>& v : state.v) v = random.vector(3).template cast<Real>();
  }
  void act(double seconds, Executor* executor = nullptr) {
    Profile profile;
    dashpots.act(model, seconds, state, nullptr, executor, profile);
  }
  double energy() const { return kinetic_energy(model, state); }
  Vec3d momentum() const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < state.v.size(); ++i)
      sum += (model.mass[i] * state.v[i]).template cast<double>();
    return sum;
  }
  Vec3d angular_momentum() const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < state.v.size(); ++i)
      sum += (model.mass[i] * state.x[i].cross(state.v[i])).template cast<double>();
    return sum;
  }
};
using Moving = MovingIn<double>;

}  // namespace

TEST_CASE("damped bending resists no bent cloth that moves and turns as a rigid body, to 1e-12") {
  for (const ClothDef& sheet : sheets(0.1)) {
    Moving cloth(sheet);
    cloth.bend();
    const Vec3d spin(0.5, -2, 3), drift(1, 2, 3);
    for (std::size_t i = 0; i < cloth.state.v.size(); ++i)
      cloth.state.v[i] = drift + spin.cross(cloth.state.x[i]);
    const Vec3Array<double> before = cloth.state.v;
    cloth.act(1.0 / 60);
    for (std::size_t i = 0; i < before.size(); ++i)
      REQUIRE((cloth.state.v[i] - before[i]).norm() < 1e-12);
    for (std::size_t i = 0; i < before.size(); ++i)
      cloth.state.v[i] = 3 * Vec3d(0, cloth.state.x[i][1], 0);
    const double bending = cloth.energy();
    cloth.act(1.0 / 60);
    CHECK(cloth.energy() < bending - 1e-5);
  }
}

TEST_CASE("it takes energy from every other motion, and no momentum, for whatever time and mesh") {
  SeededRandom random(8);
  for (const double time : {1e-3, 0.1, 10.0}) {
    for (const ClothDef& sheet : sheets(time)) {
      Moving cloth(sheet);
      cloth.state.x = test::shaken(cloth.model, 0.02, random);
      for (int trial = 0; trial < 10; ++trial) {
        INFO(time << " s, " << cloth.dashpots.stages(cloth.model, 1.0 / 60) << " stages");
        for (Vec3d& v : cloth.state.v) v = random.vector(3);
        const double before = cloth.energy();
        const Vec3d linear = cloth.momentum(), angular = cloth.angular_momentum();
        cloth.act(1.0 / 60);
        CHECK(cloth.energy() < before);
        CHECK((cloth.momentum() - linear).norm() < 1e-12);
        CHECK((cloth.angular_momentum() - angular).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("a cylinder that widens loses what its bending has, twice in each relaxation time") {
  // Its curvatures grow as they are, along the normal. With a held strip some triangles have none.
  for (const double held : {0.0, 0.25}) {
    for (const ClothDef& sheet : sheets(0.1)) {
      WorldDef def = test::empty_world(sheet);
      if (held > 0) def.pins = {{EdgeStrip{Side::top, held}, 0, {}}};
      Moving cloth(sheet);
      cloth.model = World<double>(def).model();
      cloth.dashpots.prepare(cloth.model);
      cloth.bend();
      for (std::size_t i = 0; i < cloth.state.v.size(); ++i)
        cloth.state.v[i] = Vec3d(cloth.state.x[i][0], cloth.state.x[i][1], 0);
      constexpr double kTime = 1e-7;
      const double before = cloth.energy();
      cloth.act(kTime);
      const double expected = 2 * 0.1 * elastic_energy(cloth.model, cloth.state.x).bending * kTime;
      INFO("held " << held << " m: lost " << (before - cloth.energy()) / expected);
      CHECK(before - cloth.energy() == Approx(expected).epsilon(0.02));
    }
  }
}

TEST_CASE("what holds a cloth gets all the momentum that damped bending takes from it") {
  SeededRandom random(9);
  for (const ClothDef& sheet : sheets(0.1)) {
    WorldDef def = test::empty_world(sheet);
    def.pins = {{0, 0.25, {}}};
    World<double> world(def);
    HeldForces<double> held;
    held.begin_tick(world.model(), world.pins());
    Moving cloth(sheet);
    cloth.state = world.state();
    for (std::size_t i = 0; i < cloth.state.v.size(); ++i)
      if (cloth.state.inverse_mass[i] > 0) cloth.state.v[i] = random.vector(3);
    const Vec3d before = cloth.momentum();
    Profile profile;
    cloth.dashpots.act(cloth.model, 1.0 / 60, cloth.state, &held, nullptr, profile);
    Vec3d given = Vec3d::Zero();
    for (Index i = 0; i < cloth.model.particle_count(); ++i)
      if (held.holds(i)) given += held.impulse(i);
    CHECK(given.norm() > 1e-4);
    CHECK((before - cloth.momentum() - given).norm() < 1e-12);
  }
}

TEMPLATE_TEST_CASE("a pass leaves the same bits with one and two threads", "", float, double) {
  SeededRandom random(10);
  test::TwoThreads two_threads;
  // Bands meet within a row of the grid.
  for (ClothDef sheet : {test::flat_cloth(71, 65, 1, 0.8),
                         test::triangle_sheet(test::Cut::irregular, 1, 0.8, 0.011)}) {
    sheet.fabric.bending_warp = sheet.fabric.bending_weft = 1e-3;
    sheet.fabric.bending_damping = 0.01;
    MovingIn<TestType> one(sheet);
    one.shake(random);
    MovingIn<TestType> two = one;
    const int shared = two_threads.shared();
    for (int pass = 0; pass < 2; ++pass) {
      one.act(1.0 / 60);
      two.act(1.0 / 60, &two_threads);
    }
    INFO(one.model.particle_count() << " particles");
    CHECK(two.state.v == one.state.v);
    CHECK(two_threads.shared() > shared);
  }
}

TEMPLATE_TEST_CASE("every instruction set leaves the same bits after a pass", "", float, double) {
  SeededRandom random(11);
  for (ClothDef sheet : {test::flat_cloth(11, 21, 1, 0.8),
                         test::triangle_sheet(test::Cut::irregular, 1, 0.8, 0.1)}) {
    sheet.fabric.bending_warp = sheet.fabric.bending_weft = 1e-2;
    sheet.fabric.bending_damping = 0.1;
    MovingIn<TestType> cloth(sheet);
    cloth.shake(random);
    const MovingIn<TestType> start = cloth;
    cloth.act(1.0 / 60);
    test::for_each_target([&] {
      MovingIn<TestType> other = start;
      other.act(1.0 / 60);
      CHECK(other.state.v == cloth.state.v);
    });
  }
}

TEST_CASE(
    "a relaxation time that takes too many stages is refused, with the longest there may be") {
  ClothDef sheet = test::flat_cloth(33, 33, 0.02, 0.02);
  const auto refusal = [&sheet](double time) -> std::optional<DefinitionError> {
    sheet.fabric.bending_damping = time;
    try {
      const World<float> world(test::empty_world(sheet));
    } catch (const DefinitionError& error) {
      return error;
    }
    return {};
  };
  const auto error = refusal(10);
  REQUIRE(error);
  CHECK(error->field == "fabric.bending_damping");
  REQUIRE(error->limit.starts_with("at most "));
  const double longest = std::stod(error->limit.substr(8));
  INFO(error->limit);
  CHECK(longest > 1e-3);
  CHECK(!refusal(0.99 * longest));
  CHECK(refusal(1.01 * longest));
}
