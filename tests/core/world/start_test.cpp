#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/scenes/scenes.h"
#include "core/world/world.h"

// A start other than flat (start.h).

using namespace weft;

namespace {

WorldDef hammock() {
  WorldDef def = make_scene("hammock", "");
  def.environment.wind.setZero();
  return def;
}

/// The state of a world as a start.
StartDef start_of(const World<float>& world) {
  StartDef start;
  for (const Vec3f& x : world.state().x) start.x.push_back(x.cast<double>());
  for (const Vec3f& v : world.state().v) start.v.push_back(v.cast<double>());
  return start;
}

}  // namespace

TEST_CASE("a world begins at its start, and is there again after a reset") {
  World<float> before(hammock());
  for (int n = 0; n < 5; ++n) before.step();
  WorldDef def = hammock();
  def.start = start_of(before);
  World<float> world(def);
  CHECK(world.state().x == before.state().x);
  CHECK(world.state().v == before.state().v);
  const std::uint64_t begun = world.hash();
  world.step();
  CHECK(world.hash() != begun);
  world.reset();
  CHECK(world.hash() == begun);
}

TEST_CASE(
    "what is strained at the start pulls itself together: the rest shape is the cloth's own") {
  World<float> at_rest(hammock());
  WorldDef def = hammock();
  def.start = start_of(at_rest);
  def.start->v.clear();
  for (Vec3d& x : def.start->x) x *= 1.01;
  const World<float> stretched(def);
  CHECK(stretched.report().energies.stretch > 100 * at_rest.report().energies.stretch + 1e-6);
}

TEST_CASE("a start of another number of particles, or of none that could be, is refused by name") {
  const auto [change, field] = GENERATE(table<void (*)(StartDef&), const char*>({
      {[](StartDef& start) { start.x.pop_back(); }, "start.x"},
      {[](StartDef& start) { start.v.pop_back(); }, "start.v"},
      {[](StartDef& start) { start.x[7].z() = std::numeric_limits<double>::quiet_NaN(); },
       "start.x[7]"},
      {[](StartDef& start) { start.x[7].x() = -1001; }, "start.x[7]"},
      {[](StartDef& start) { start.v[9].y() = 101; }, "start.v[9]"},
  }));
  WorldDef def = hammock();
  def.start = start_of(World<float>(def));
  change(*def.start);
  try {
    const World<float> world(def);
    FAIL("it was taken");
  } catch (const DefinitionError& error) {
    CHECK(error.field == field);
  }
}

TEST_CASE("a start in which the ends of an edge are in one place is refused, and named by them") {
  WorldDef def = hammock();
  const World<float> world(def);
  const StartDef start = start_of(world);
  const auto [a, b] = world.model().edges.back();
  const auto refusal = [&](const StartDef& wrong) {
    def.start = wrong;
    try {
      const World<float> taken(def);
    } catch (const DefinitionError& error) {
      return error.field + " " + error.value;
    }
    return std::string("it was taken");
  };
  StartDef fallen = start, point = start;
  fallen.x[static_cast<std::size_t>(a)] = fallen.x[static_cast<std::size_t>(b)];
  for (Vec3d& x : point.x) x = Vec3d(0.1, 1, 0.2);
  CHECK(refusal(fallen) ==
        "start.x particles " + std::to_string(a) + " and " + std::to_string(b) + " in one place");
  CHECK(refusal(point).starts_with("start.x particles "));
  CHECK(refusal(start) == "it was taken");
}
