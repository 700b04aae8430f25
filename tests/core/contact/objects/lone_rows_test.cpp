#include "core/contact/objects/lone_rows.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "core/world/world.h"
#include "tests/support/seeded_random.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

// Contacts of single particles are worked on several at a time, with the bits that one after the
// other gives. The balance of energy wants each impulse, and there they respond one after the
// other.

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

/// Cloths that fall on the ground, a ball, a rod and each other's edges, with a little motion of
/// their own.
WorldDef heap_of_shapes(double friction, unsigned seed) {
  WorldDef def = test::empty_world(test::flat_cloth(23, 31));
  ClothDef& cloth = def.cloths[0];
  cloth.origin = Vec3d(-0.5, 0.45, -0.4);
  cloth.v = Vec3d(0, 0.3, 1).normalized();
  cloth.fabric.thickness = 0.006;
  cloth.fabric.friction = friction;
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.environment.damping = 1;
  def.colliders = {{"ground", PlaneDef{}},
                   {"ball", SphereDef{Vec3d(0.1, 0.2, 0), 0.2}},
                   {"rod", CapsuleDef{Vec3d(-0.4, 0.1, -0.5), Vec3d(-0.3, 0.15, 0.5), 0.05}}};
  def.contact.seed.self = seed % 2 == 0 ? SelfContact::none : SelfContact::guard;
  return def;
}

/// What is told of contacts: nothing, mean forces, each impulse, or both of these.
enum class Told { nothing, forces, each, both };

struct Fall {
  std::uint64_t hash = 0, rubbed = 0;
  std::vector<ContactPoint> contacts;  ///< of the last tick, if they are told
};

/// @param sweeps  the ball moves through the cloth
template <class Real>
Fall fall(const WorldDef& def, unsigned seed, bool sweeps, Told told) {
  World<Real> world(def);
  MoveDef across;
  across.target.position = Vec3d(0.1, 0.25, 0.4);
  across.speed = 0.5;
  if (sweeps) REQUIRE(world.move_collider(1, across));
  Random random(seed);
  for (Vec3<Real>& v : world.state().v) v = random.vector(0.5).cast<Real>();
  world.accept_state();
  world.measure_forces(told == Told::forces || told == Told::both);
  world.measure_energy(told == Told::each || told == Told::both);
  Fall result;
  for (int tick = 0; tick < 60; ++tick) result.rubbed += world.step().profile[Stage::friction].work;
  result.hash = world.hash();
  if (world.reactions()) result.contacts = world.reactions()->contacts;
  return result;
}

ContactRow<float> row_of(std::initializer_list<Index> particles) {
  ContactRow<float> row;
  for (const Index i : particles) row.particle[row.count++] = i;
  return row;
}

}  // namespace

TEMPLATE_TEST_CASE("contacts worked on all at once leave the bits of one after the other", "",
                   float, double) {
  const double friction = GENERATE(0.0, 0.4);
  const unsigned seed = GENERATE(from_range(test::seeds(1, 4)));
  const test::Repeatable repeatable(seed);
  const WorldDef def = heap_of_shapes(friction, seed);
  const bool sweeps = GENERATE(false, true);
  const Fall singly = fall<TestType>(def, seed, sweeps, Told::each);
  for (const Told told : {Told::nothing, Told::forces}) {
    const Fall at_once = fall<TestType>(def, seed, sweeps, told);
    CHECK(at_once.hash == singly.hash);
    CHECK(at_once.rubbed == singly.rubbed);
  }
  CHECK((singly.rubbed > 0) == (friction > 0));
}

TEST_CASE("contacts worked on all at once are told with the forces of one after the other") {
  const bool sweeps = GENERATE(false, true);
  const WorldDef def = heap_of_shapes(0.4, 2);
  const std::vector<ContactPoint> at_once = fall<float>(def, 2, sweeps, Told::forces).contacts,
                                  singly = fall<float>(def, 2, sweeps, Told::both).contacts;
  REQUIRE(at_once.size() == singly.size());
  double most = 0;
  for (const ContactPoint& contact : singly) most = std::max(most, contact.force().norm());
  REQUIRE(most > 0);
  for (std::size_t k = 0; k < singly.size(); ++k) {
    CHECK(at_once[k].particle == singly[k].particle);
    CHECK((at_once[k].force() - singly[k].force()).norm() < 1e-5 * most);
  }
}

TEST_CASE("a large cloth on the ground has the same bits with one and two threads") {
  WorldDef def = test::empty_world(test::flat_cloth(71, 73, 1.5, 1.5));
  def.cloths[0].origin = Vec3d(0, 0.008, 0);
  def.environment.gravity = Vec3d(0, -9.81, 0);
  def.colliders = {{"ground", PlaneDef{}}};
  test::TwoThreads two_threads;
  World<float> alone(def), shared(def, {&two_threads, nullptr});
  SeededRandom random(1);
  for (std::size_t i = 0; i < alone.state().v.size(); ++i)
    alone.state().v[i] = shared.state().v[i] = random.vector(0.5).cast<float>();
  alone.accept_state();
  shared.accept_state();
  std::uint64_t rubbed = 0, steps = 0;
  for (int tick = 0; tick < 12; ++tick) {
    rubbed += alone.step().profile[Stage::friction].work;
    steps += static_cast<std::uint64_t>(alone.report().substeps);
    shared.step();
    REQUIRE(alone.hash() == shared.hash());
  }
  CHECK(rubbed > 2048 * steps / 2);  // most of it touches
}

namespace {

/// Particles about the ground, each with a row but for every `gap`-th, moved as one step does.
struct Layer {
  explicit Layer(std::size_t count, std::size_t gap) : x(3 * count), v(3 * count), reach(count, 1) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        x[3 * i + c] = static_cast<float>(random.uniform(0, 0.006));
        v[3 * i + c] = static_cast<float>(random.uniform(-1, 1));
      }
      if (i % gap == 0) continue;
      ContactRow<float> row = row_of({static_cast<Index>(i)});
      row.normal = Vec3f::UnitY();
      row.thickness = 0.004f;
      row.friction = 0.4f;
      rows.push_back(row);
    }
    from = x;
    travel2.assign(count, 0);
    lone.find(rows, std::vector<RowRoom<float>>(rows.size(), {{}, -1, 1}), {ContactDef{}}, count);
  }
  LoneResponse<float> respond(Executor* executor) {
    LonePass<float> pass{x.data(), v.data(), 1e-3f, 1e-6f, 0.2f, 5e-4f, 5e-3f};
    pass.from = from.data();
    pass.reach = reach.data();
    pass.travel2 = travel2.data();
    return lone.respond(pass, executor);
  }
  SeededRandom random{7};
  std::vector<float> x, v, from, reach, travel2;
  std::vector<ContactRow<float>> rows;
  LoneRows<float> lone;
};

}  // namespace

TEST_CASE("lone rows that are shared out to threads leave what one thread does") {
  // The last block of rows begins among the particles of the one before.
  const std::size_t gap = GENERATE(3u, 1000u);
  Layer alone(2405, gap), shared(2405, gap);
  test::TwoThreads two_threads;
  const LoneResponse<float> one = alone.respond(nullptr), two = shared.respond(&two_threads);
  CHECK(two_threads.shared() > 0);
  CHECK(one.friction_evaluations > 100);
  CHECK(one.friction_evaluations == two.friction_evaluations);
  CHECK(one.largest == two.largest);
  CHECK(one.within == two.within);
  CHECK(alone.x == shared.x);
  CHECK(alone.v == shared.v);
  CHECK(alone.travel2 == shared.travel2);
  CHECK(alone.x != alone.from);
}

TEST_CASE("who is in no lone row is not touched, wherever it goes") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const std::size_t count : {3u, 8u, 12u, 21u}) {
    Layer layer(count, 2);
    for (std::size_t i = 0; i < count; i += 2) layer.travel2[i] = kNan;
    const std::vector<float> x = layer.x, v = layer.v;
    layer.respond(nullptr);
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (k / 3 % 2 == 1) continue;
      CHECK(layer.x[k] == x[k]);
      CHECK(layer.v[k] == v[k]);
    }
    std::size_t crossing = 0;
    for (std::size_t i = 0; i < count; ++i) layer.travel2[i] = i % 2 == 0 ? kNan : 2.f;
    layer.lone.for_each_crossing(layer.travel2.data(), [&](std::size_t) { ++crossing; });
    CHECK(crossing == (count < kLoneLanes ? 0 : layer.rows.size()));
  }
}

TEST_CASE("a row is lone if its particle is in no other one and it responds simply") {
  std::vector<ContactRow<float>> rows = {row_of({7}), row_of({5}), row_of({5}), row_of({2, 3}),
                                         row_of({3}), row_of({1}), row_of({0})};
  rows[5].responds = false;
  LoneRows<float> lone;
  lone.find(rows, std::vector<RowRoom<float>>(rows.size()), {ContactDef{}}, 9);
  std::vector<Index> found;
  for (const LoneBlock<float>& block : lone.blocks())
    std::copy_if(block.row, block.row + kLoneLanes, std::back_inserter(found),
                 [](Index row) { return row != kNone; });
  CHECK(found == std::vector<Index>{6, 0});  // by particle
  for (std::size_t r = 0; r < rows.size(); ++r) CHECK(lone.has(r) == (r == 0 || r == 6));
}
