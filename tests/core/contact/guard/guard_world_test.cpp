#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/scenes/scenes.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets.h"
#include "tests/support/two_threads.h"
#include "tests/support/worlds.h"

// Cloths that meet themselves and each other: nothing crosses at any tick, and it is not by
// freezing.

using namespace weft;
using namespace weft::test;

namespace {

/// Steps and adds up the crossings seen after each tick.
template <class Real>
std::size_t crossings_over(World<Real>& world, int ticks) {
  std::size_t sum = 0;
  for (int k = 0; k < ticks; ++k) {
    const TickReport& report = world.step();
    if (report.divergence) FAIL(describe(*report.divergence));
    sum += crossings(world);
  }
  return sum;
}

/// A sheet of `n` x `n` particles that falls upright on the ground and crumples there.
WorldDef upright_drop(int n, double thickness_part) {
  return upright_sheet(n, 0.6, 0.75, thickness_part, 0.2);
}

/// Pairs without a common particle whose features could meet now, as each particle may be as far
/// off its predicted path as the reach; and how many of these the guard does not look at.
struct NearPairs {
  std::size_t near = 0, missed = 0;
};
NearPairs near_pairs(const World<float>& world) {
  const ClothGuard<float>& guard = *world.guard();
  const ClothModel<float>& model = world.model();
  std::set<std::uint64_t> known;
  for (const GuardedPair<float>& pair : guard.pairs()) {
    if (!pair.gone) known.insert(key_of(pair));
  }
  Vec3Array<float> path;
  for (std::size_t i = 0; i < world.state().x.size(); ++i) path.push_back(guard.predicted(i));
  NearPairs count;
  const auto look = [&](PairKind kind, std::size_t a, std::size_t b,
                        const std::array<Index, 4>& particle) {
    const std::size_t middle = first_side(kind);
    for (std::size_t k = middle; k < 4; ++k) {
      if (std::find(particle.begin(), particle.begin() + static_cast<std::ptrdiff_t>(middle),
                    particle[k]) != particle.begin() + static_cast<std::ptrdiff_t>(middle))
        return;
    }
    GuardedPair<float> pair;
    pair.kind = kind;
    pair.a = static_cast<Index>(a);
    pair.b = static_cast<Index>(b);
    PairPoints<float> x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = path[static_cast<std::size_t>(particle[k])];
    // Far pairs need no exact distance.
    if ((x[0] - x[3]).norm() > 0.2f || separate_pair(kind, x).gap > 2 * guard.reach()) return;
    ++count.near;
    if (!known.contains(key_of(pair))) ++count.missed;
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
      const Triangle& c = model.triangles[t];
      look(PairKind::vertex_triangle, i, t, {static_cast<Index>(i), c[0], c[1], c[2]});
    }
  }
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    for (std::size_t f = e + 1; f < model.edges.size(); ++f) {
      const Edge &c = model.edges[e], &d = model.edges[f];
      look(PairKind::edge_edge, e, f, {c[0], c[1], d[0], d[1]});
    }
  }
  return count;
}

}  // namespace

TEST_CASE("a sheet that crumples on the ground crosses itself at no tick, and moves freely") {
  const double part = GENERATE(0.25, 0.5);
  World<float> world(upright_drop(20, part));
  jolt(world, 0.05, 1);
  CHECK(crossings_over(world, 120) == 0);
  INFO("thickness " << part << " of the edge, lost " << lost_fraction(world));
  CHECK(world.guard()->counts().anchored > 100);  // it met itself
  CHECK(lost_fraction(world) < 0.2);
  CHECK(world.deepest_penetration() < 1e-5);
}

TEST_CASE("the guard looks at every pair that could meet, also after some left their paths") {
  World<float> world(upright_drop(14, 0.25));
  jolt(world, 0.3, 3);
  std::size_t near = 0;
  for (int tick = 0; tick < 60; ++tick) {
    REQUIRE_FALSE(world.step().divergence);
    const NearPairs pairs = near_pairs(world);
    INFO("tick " << tick);
    REQUIRE(pairs.missed == 0);
    near += pairs.near;
  }
  CHECK(near > 1000);
  CHECK(world.guard()->counts().renewals > 30);
}

TEST_CASE("a crumpling sheet leaves the same bits with one and two threads") {
  TwoThreads two_threads;
  World<float> one(upright_drop(32, 0.25)), two(upright_drop(32, 0.25), {&two_threads, nullptr});
  for (World<float>* world : {&one, &two}) {
    jolt(*world, 0.05, 4);
    for (int tick = 0; tick < 45; ++tick) world->step();
  }
  CHECK(two_threads.shared() > 1000);
  CHECK(one.guard()->pairs().size() == two.guard()->pairs().size());
  CHECK(one.hash() == two.hash());
}

TEST_CASE("a pile that a hand pulls apart leaves the same bits with one and two threads") {
  TwoThreads two_threads;
  World<float> one(upright_drop(60, 0.25)), two(upright_drop(60, 0.25), {&two_threads, nullptr});
  std::size_t rows = 0;
  for (World<float>* world : {&one, &two}) {
    jolt(*world, 0.05, 5);
    for (int tick = 0; tick < 40; ++tick) world->step();
    rows = world->guard()->rows().size();
    GrabDef grab;
    grab.triangle = 40;
    grab.stiffness = 500;
    grab.target =
        world->state().x[static_cast<std::size_t>(world->model().triangles[40][0])].cast<double>();
    const GrabId hand = world->grab(grab);
    for (int tick = 0; tick < 12; ++tick) {
      grab.target += Vec3d(0.01, 0.02, 0);
      world->move_grab(hand, grab.target);
      world->step();
    }
  }
  CHECK(rows > 700);  // many enough to be swept on both
  CHECK(one.hash() == two.hash());
}

TEST_CASE("what cloth wanted in a step in which it is made to stand still counts as lost") {
  World<float> world(upright_drop(14, 0.25));
  jolt(world, 0.3, 3);
  for (int tick = 0; tick < 40; ++tick) world.step();
  ClothState<float> state = world.state();
  ClothGuard<float> guard(world.model());
  Profile profile;
  guard.solve(state, 1e-4F, profile);
  guard.certify(
      state, 1e-4F, [] { return 0.0F; }, profile);
  const double wanted = guard.counts().wanted;
  CHECK(wanted > 0);
  CHECK(guard.counts().truncated < 0.5 * wanted);
  guard.stand_still();
  CHECK(guard.counts().truncated == Approx(wanted));
}

TEST_CASE("a contact that has no objects lets the guard respond as it does alone") {
  World<float> world(upright_drop(14, 0.25));
  jolt(world, 0.3, 3);
  for (int tick = 0; tick < 40; ++tick) world.step();
  constexpr float kStep = 1e-4F;
  const auto velocities_after = [&](auto&& respond) {
    ClothState<float> state = world.state();
    ClothGuard<float> guard(world.model());
    Profile profile;
    for (int step = 0; step < 4; ++step) {
      guard.solve(state, kStep, profile);
      respond(state, profile, guard);
      guard.certify(
          state, kStep, [] { return 0.0F; }, profile);
      for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += state.v[i] * kStep;
      guard.finish(state);
    }
    return state.v;
  };
  Contact<float> none;
  const auto with_contact = velocities_after([&](auto& state, auto& profile, auto& guard) {
    none.resolve(state, kStep, profile, &guard);
  });
  const auto alone =
      velocities_after([](auto& state, auto&, auto& guard) { guard.respond_alone(state, kStep); });
  CHECK(with_contact == alone);
  CHECK(velocities_after([](auto&...) {}) != alone);
}

TEST_CASE("the same sheet without the guard crosses itself") {
  WorldDef def = upright_drop(20, 0.25);
  def.contact.seed.self = SelfContact::none;
  World<float> world(def);
  jolt(world, 0.05, 1);
  std::size_t seen = 0;
  for (int tick = 0; tick < 60 && seen == 0; ++tick) seen = crossings_over(world, 1);
  CHECK(seen > 0);
}

TEST_CASE("a crumpling sheet in double crosses nothing either") {
  World<double> world(upright_drop(12, 0.25));
  jolt(world, 0.05, 2);
  CHECK(crossings_over(world, 90) == 0);
  CHECK(lost_fraction(world) < 0.2);
}

TEST_CASE("where nothing touches, a run with the guard is that without it, bit for bit") {
  WorldDef def;
  def.cloths[0] = flat_cloth(25, 25);
  def.cloths[0].v = -Vec3d::UnitY();
  for (Index i = 0; i < 25; i += 4) def.pins.push_back({i, 0});
  def.environment.wind = Vec3d(0.5, 0, 2);
  def.colliders = {{"ground", PlaneDef{Vec3d(0, -3, 0), Vec3d::UnitY()}}};
  World<float> without(def);
  def.contact.seed.self = SelfContact::guard;
  World<float> with(def);
  for (int k = 0; k < 90; ++k) {
    without.step();
    with.step();
    REQUIRE(with.hash() == without.hash());
  }
  CHECK(with.guard()->counts().collections > 0);
  CHECK(with.report().profile[Stage::contact].work ==
        without.report().profile[Stage::contact].work);
}

namespace {

/// Two sheets, the second one turned a little, one thickness apart, that fly at each other.
WorldDef two_sheets() {
  WorldDef def = empty_world(flat_cloth(14, 14, 0.4, 0.4));
  ClothDef second = flat_cloth(11, 17, 0.4, 0.4);
  second.origin = Vec3d(0.03, 0.03, -0.02);
  second.u = Vec3d(1, 0.02, 0.3).normalized();
  second.v = Vec3d(-0.3, 0, 1).normalized();
  second.u = (second.u - second.v * second.v.dot(second.u)).normalized();
  second.name = "second";
  def.cloths.push_back(second);
  for (ClothDef& cloth : def.cloths) cloth.fabric.thickness = 0.006;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

}  // namespace

TEST_CASE("two sheets that fly at each other do not pass, keep momentum and lose energy") {
  for (const double speed : {0.5, 5.0, 40.0}) {
    World<double> world(two_sheets());
    ClothState<double>& state = world.state();
    const auto first = static_cast<std::size_t>(world.model().parts[1].particles.first);
    for (std::size_t i = 0; i < state.v.size(); ++i)
      state.v[i] = Vec3d(0, i < first ? speed : -speed, 0.1 * speed);
    world.accept_state();
    const auto momentum = [&] {
      Vec3d sum = Vec3d::Zero();
      for (std::size_t i = 0; i < state.v.size(); ++i) sum += state.v[i] * world.model().mass[i];
      return sum;
    };
    const Vec3d before = momentum();
    const double energy = world.report().energies.total();
    INFO(speed << " m/s");
    CHECK(crossings_over(world, 40) == 0);
    CHECK((momentum() - before).norm() < 0.02 * speed);
    CHECK(world.report().energies.total() < energy);
  }
}

TEST_CASE("noise of 20 m/s on all particles makes no crossing") {
  for (const unsigned seed : seeds(1, 3)) {
    const Repeatable repeatable(seed);
    WorldDef def = empty_world(flat_cloth(14, 14, 0.4, 0.4));
    def.cloths[0].fabric.thickness = 0.008;
    def.contact.seed.self = SelfContact::guard;
    World<float> world(def);
    jolt(world, 20, seed);
    std::size_t sum = 0;
    for (int k = 0; k < 60; ++k) {
      world.step();
      sum += crossings(world);
    }
    CHECK(sum == 0);
  }
}

TEST_CASE("hands at 5 m/s that pull a crumpled sheet about make no crossing") {
  World<float> world(upright_drop(12, 0.25));
  jolt(world, 0.05, 4);
  CHECK(crossings_over(world, 40) == 0);
  SeededRandom random(9);
  const auto triangles = static_cast<Index>(world.model().triangles.size());
  for (int drag = 0; drag < 6; ++drag) {
    std::vector<GrabId> hands;
    std::vector<Vec3d> at, speed;
    for (int k = 0; k < 3; ++k) {
      GrabDef grab;
      grab.triangle = random.index(triangles);
      grab.barycentric = {0.3, 0.3, 0.4};
      grab.radius = 0.03;
      const Triangle& t = world.model().triangles[static_cast<std::size_t>(grab.triangle)];
      at.push_back(world.state().x[static_cast<std::size_t>(t[0])].cast<double>());
      speed.push_back(random.vector(1).normalized() * 5);
      grab.target = at.back();
      hands.push_back(world.grab(grab));
    }
    for (int tick = 0; tick < 12; ++tick) {
      for (std::size_t k = 0; k < hands.size(); ++k) {
        at[k] += speed[k] / 60;
        world.move_grab(hands[k], at[k]);
      }
      world.step();
      REQUIRE(crossings(world) == 0);
    }
    for (const GrabId hand : hands) world.release(hand);
  }
}

TEST_CASE("a sheet folded over itself comes to rest with its layers a thickness apart") {
  WorldDef def = upright_drop(17, 0.25);
  ClothDef& cloth = def.cloths[0];
  cloth.v = Vec3d::UnitZ();
  const double thickness = cloth.fabric.thickness;
  cloth.origin = Vec3d(-0.3, 2 * thickness, -0.3);
  World<float> world(def);
  // Folded in the middle round a bend of two edge lengths, before it starts.
  ClothState<float>& state = world.state();
  for (Vec3f& x : state.x) {
    const double bend = 0.03, s = static_cast<double>(x[2]), over = s / bend;
    if (s <= 0) continue;
    const Vec3d p = over < 3.14159 ? Vec3d(0, bend * (1 - std::cos(over)), bend * std::sin(over))
                                   : Vec3d(0, 2 * bend, -(s - 3.14159 * bend));
    x = Vec3f(x[0], static_cast<float>(2 * thickness + p[1]), static_cast<float>(p[2]));
  }
  world.accept_state();
  REQUIRE(crossings(world) == 0);
  CHECK(crossings_over(world, 180) == 0);
  // The end of the upper layer lies on the lower one.
  double lowest = 1;
  for (Index c = 0; c < 17; ++c)
    lowest =
        std::min(lowest, static_cast<double>(state.x[static_cast<std::size_t>(16 * 17 + c)][1]));
  CHECK(lowest > 1.7 * thickness);
  CHECK(lowest < 2.6 * thickness);
  CHECK(lost_fraction(world) < 0.01);
}

TEST_CASE("the guard is chosen by name and goes with the contact of weft alone") {
  WorldDef def;
  set_field(def, "contact.self", "guard");
  CHECK_NOTHROW(validate(def));
  CHECK(World<float>(def).guard() != nullptr);
  set_field(def, "contact.model", "seed");
  CHECK_THROWS_AS(validate(def), DefinitionError);
  set_field(def, "contact.model", "weft");
  set_field(def, "contact.self", "particles");
  CHECK_THROWS_AS(validate(def), DefinitionError);
}

TEST_CASE("layers that a hand presses on a ball with 50 N lose at most 1 % of their motion") {
  WorldDef def;
  def.cloths.clear();
  for (int k = 0; k < 4; ++k) {
    ClothDef sheet;
    sheet.name = "sheet" + std::to_string(k);
    sheet.rows = sheet.columns = 13;
    sheet.width = sheet.height = 0.3;
    sheet.origin = Vec3d(-0.15 + 0.003 * k, 0.406 + 0.006 * k, -0.15);
    sheet.v = Vec3d::UnitZ();
    def.cloths.push_back(sheet);
  }
  def.colliders = {{"ball", SphereDef{Vec3d(0, 0.2, 0), 0.2}}};
  def.contact.seed.self = SelfContact::guard;
  def.environment.damping = 1;
  World<float> world(def);
  CHECK(crossings_over(world, 20) == 0);
  GrabDef hand;
  hand.triangle = static_cast<Index>(3 * 288 + 6 * 24 + 12);
  hand.radius = 0.06;
  hand.target = Vec3d(0, -1, 0);
  world.grab(hand);
  CHECK(crossings_over(world, 15) == 0);
  CHECK(world.grabs().list[0].force.norm() > 49.9);
  CHECK(lost_fraction(world) < 0.01);
}
