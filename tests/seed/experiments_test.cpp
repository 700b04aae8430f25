#include <algorithm>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "core/scenes/scenes.h"
#include "tests/support/folds.h"

// The seed's experiments with hands and pins, V.B.4 to V.B.6, and its default scene.

using namespace weft;
using namespace weft::test;

namespace {

Vec3d at(const World<float>& world, Index particle) {
  return world.state().x[static_cast<std::size_t>(particle)].cast<double>();
}

double lowest(const World<float>& world) {
  double height = std::numeric_limits<double>::infinity();
  for (const Vec3f& x : world.state().x) height = std::min(height, static_cast<double>(x[1]));
  return height;
}

/// A hand at a particle, through a triangle that has it.
GrabDef hand_at(const World<float>& world, Index particle) {
  GrabDef hand;
  const std::vector<Triangle>& triangles = world.model().triangles;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (triangles[k][corner] != particle) continue;
      hand.triangle = static_cast<Index>(k);
      hand.barycentric = {0, 0, 0};
      hand.barycentric[corner] = 1;
    }
  }
  return hand;
}

}  // namespace

TEST_CASE("Fig. 9: the seed's default scene holds its cloth by six particles before the form") {
  World<float> world(make_scene("seed-fig9-default"));
  CHECK(world.model().particle_count() == 600);
  CHECK(std::string(solver_name(world.def())) == "relaxation");
  CHECK(contact_of(world.def()) == ContactModel::seed);
  for (const SpringKind kind :
       {SpringKind::warp, SpringKind::weft, SpringKind::shear, SpringKind::skip})
    CHECK(std::count(world.model().spring_kinds.begin(), world.model().spring_kinds.end(), kind) >
          0);
  std::vector<Index> fixed;
  for (Index i = 0; i < 600; ++i) {
    if (world.state().inverse_mass[static_cast<std::size_t>(i)] == 0) fixed.push_back(i);
  }
  REQUIRE(fixed.size() == 6);
  step(world, 120);
  for (const Index i : fixed)
    CHECK(at(world, i) == world.model().rest_positions[static_cast<std::size_t>(i)].cast<double>());
  CHECK(world.report().largest_strain < 0.15);
  CHECK(lowest(world) > 0.2);
}

TEST_CASE("Figs. 13, 14, V.B.4: fixed particles stay where they are, to the bit, others hang") {
  World<float> world(make_scene("seed-fig14-fixing"));
  const Vec3Array<float> start = world.state().x;
  step(world, 120);
  std::size_t fixed = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (world.state().inverse_mass[i] > 0) continue;
    ++fixed;
    CHECK(world.state().x[i] == start[i]);
  }
  CHECK(fixed == 4);
  // The corners of the sheet hang, below what is fixed.
  for (const Index corner : {0, 24, 24 * 25, 25 * 25 - 1}) CHECK(at(world, corner)[1] < 1.1);
  // Fixing one more holds it there.
  const Vec3d before = at(world, 0);
  world.pin({0, 0, {}});
  step(world, 30);
  CHECK(at(world, 0) == before);
}

TEST_CASE("Fig. 15, V.B.5: corners are freed one by one, and the sheet hangs by what is left") {
  World<float> world(make_scene("seed-fig15-corners"));
  const std::vector<Index> corners = {0, 24, 24 * 25, 25 * 25 - 1};
  const auto pins = world.pins().list;
  REQUIRE(pins.size() == 4);
  step(world, 50);
  const double sag = 1.5 - lowest(world);
  CHECK(sag > 0.02);
  CHECK(sag < 0.35);
  // Free a corner: it falls. The farthest it may hang is the sheet's diagonal below the other
  // corners.
  REQUIRE(world.unpin(pins[3].id));
  step(world, 50);
  CHECK(at(world, corners[3])[1] < 1.5 - 0.4);
  REQUIRE(world.unpin(pins[2].id));
  step(world, 100);
  // Two neighbouring corners hold it now: it hangs down by its height.
  CHECK(at(world, corners[2])[1] == Approx(0.5).margin(0.12));
  CHECK(at(world, corners[3])[1] == Approx(0.5).margin(0.12));
  // Drag the lower edge towards the viewer, and let it go.
  const GrabId hand = world.grab(hand_at(world, corners[3]));
  const Vec3d target = at(world, corners[3]) + Vec3d(0, 0.2, 0.4);
  world.move_grab(hand, target);
  step(world, 40);
  CHECK((at(world, corners[3]) - target).norm() < 0.1);
  world.release(hand);
  step(world, 80);
  CHECK(at(world, corners[3])[1] == Approx(0.5).margin(0.12));
  // Free the last two: all of it comes to the ground.
  for (const std::size_t k : {0u, 1u}) REQUIRE(world.unpin(pins[k].id));
  step(world, 60);
  for (const Index corner : corners) CHECK(at(world, corner)[1] < 0.4);
  CHECK(lowest(world) > -0.001);
}

TEST_CASE("Fig. 16, V.B.6: a drag runs through the cloth, and the cloth comes back") {
  World<float> world(make_scene("seed-fig16-drag"));
  step(world, 60);
  const Index middle = 12 * 25 + 12, below = 24 * 25 + 12, top = 12;
  const std::vector<Index> along = {top, 6 * 25 + 12, middle};
  const Vec3Array<float> rest = world.state().x;
  const auto moved = [&](Index i) {
    return (world.state().x[static_cast<std::size_t>(i)] - rest[static_cast<std::size_t>(i)])
        .norm();
  };
  const GrabId hand = world.grab(hand_at(world, middle));
  // Swung about the pinned corners by 45 degrees, where springs that do not stretch let it go.
  const double arm = (1.6 - at(world, middle)[1]) / std::sqrt(2.0);
  const Vec3d target(at(world, middle)[0], 1.6 - arm, arm);
  world.move_grab(hand, target);
  step(world, 60);
  CHECK((at(world, middle) - target).norm() < 0.03);  // a spring of 150 N/m against 2 N of cloth
  // Who is nearer to the hand follows more; the pinned corners do not.
  CHECK(moved(along[2]) > moved(along[1]));
  CHECK(moved(along[1]) > moved(along[0]));
  CHECK(moved(below) > 0.2);
  CHECK(moved(0) == 0);
  world.release(hand);
  step(world, 150);
  CHECK(moved(middle) < 0.08);  // of 0.5 m; 0.06 in double precision
}

TEST_CASE("V.B.6: the seed's own drag throws the cloth towards the point where it is let go") {
  World<float> world(make_scene("seed-fig16-drag"));
  step(world, 60);
  const Index middle = 12 * 25 + 12;
  const Vec3d rest = at(world, middle);
  GrabDef sling = hand_at(world, middle);
  sling.mode = GrabMode::sling;
  sling.radius = 0.1;
  sling.stiffness = 10;
  sling.target = rest + Vec3d(0, 0, 0.5);
  const GrabId hand = world.grab(sling);
  step(world, 20);
  CHECK((at(world, middle) - rest).norm() < 0.01);  // nothing yet
  REQUIRE(world.fire(hand));
  double farthest = 0;
  for (int tick = 0; tick < 60; ++tick) {
    step(world, 1);
    farthest = std::max(farthest, at(world, middle)[2] - rest[2]);
  }
  CHECK(farthest > 0.1);
  step(world, 100);
  CHECK((at(world, middle) - rest).norm() < 0.05);
}
