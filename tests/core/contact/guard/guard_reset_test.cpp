#include <algorithm>

#include <catch2/catch.hpp>

#include "core/contact/guard/cloth_guard.h"
#include "tests/support/cloths.h"
#include "tests/support/sheets.h"
#include "tests/support/worlds.h"

// A tick may be halted anywhere in a step: after that the guard remembers nothing of it.

using namespace weft;
using namespace weft::test;

namespace {

constexpr float kStep = 1e-4F, kGravity = 9.81F;

/// Two sheets, one above the other at a quarter of the distance that they keep.
WorldDef near_sheets() {
  WorldDef def = empty_world(flat_cloth(8, 8, 0.2, 0.2));
  ClothDef second = flat_cloth(8, 8, 0.2, 0.2);
  second.origin = Vec3d(0.004, 0.001, 0.003);
  second.name = "second";
  def.cloths.push_back(second);
  for (ClothDef& cloth : def.cloths) cloth.fabric.thickness = 0.004;
  def.contact.seed.self = SelfContact::guard;
  return def;
}

/// A kick, and what the guard does before the drift up to its push.
void begin_step(ClothGuard<float>& guard, ClothState<float>& state) {
  Profile profile;
  for (Vec3f& v : state.v) v[1] -= kStep * kGravity;
  guard.solve(state, kStep, profile);
  guard.respond_alone(state, kStep);
}

void steps(ClothGuard<float>& guard, ClothState<float>& state, int count) {
  Profile profile;
  for (int k = 0; k < count; ++k) {
    begin_step(guard, state);
    guard.certify(
        state, kStep, [] { return 0.0F; }, profile);
    for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += state.v[i] * kStep;
    guard.finish(state);
  }
}

}  // namespace

TEST_CASE("a guard that is reset between its push and the drift goes on as a new one, bit by bit") {
  const World<float> world(near_sheets());
  ClothGuard<float> used(world.model()), fresh(world.model());
  ClothState<float> halted = world.state();
  steps(used, halted, 4);
  const Vec3Array<float> before = halted.v;
  begin_step(used, halted);
  float most = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    most = std::max(most, (halted.v[i] - before[i]).norm());
  REQUIRE(most > 0.01F);  // it was pushed
  used.reset();

  ClothState<float> one = world.state(), two = world.state();
  steps(used, one, 6);
  steps(fresh, two, 6);
  CHECK(one.x == two.x);
  CHECK(one.v == two.v);
}
