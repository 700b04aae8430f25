#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "core/contact/objects/contact.h"
#include "core/geometry/distance.h"
#include "tests/support/particles.h"
#include "tests/support/seeded_random.h"

// A cloth that is torn about at random on balls and rods. A ball is a rod of length 0 here.

using namespace weft;
using test::Particles;
using test::Random;

namespace {

constexpr Index kSide = 8;

template <class Real>
Particles<Real> make_patch(double cell, const Vec3d& first) {
  Particles<Real> cloth;
  cloth.add_patch(kSide, cell, first, 1e-4, 200, 40);
  cloth.dashpot = 0.02;
  return cloth;
}

ColliderDef object_of(const CapsuleDef& rod) {
  if (rod.a == rod.b) return {"ball", SphereDef{rod.a, rod.radius}};
  return {"rod", rod};
}

/// [m]
double height(const CapsuleDef& rod, const Vec3d& p) {
  return (p - rod.a - (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b)).norm() - rod.radius;
}

/// Least height of the cloth, edges and triangles one by one [m].
template <class Real>
double least_distance(const Particles<Real>& cloth, const CapsuleDef& rod) {
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& e : cloth.edges) {
    const auto s = closest_of_segments(cloth.position(e[0]), cloth.position(e[1]), rod.a, rod.b);
    least = std::min(least, (s.p - s.q).norm());
  }
  for (const Triangle& t : cloth.triangles) {
    for (const Vec3d& end : {rod.a, rod.b}) {
      const Vec3d nearest =
          closest_on_triangle(end, cloth.position(t[0]), cloth.position(t[1]), cloth.position(t[2]))
              .point;
      least = std::min(least, (nearest - end).norm());
    }
  }
  return least - rod.radius;
}

/// Hands that press the cloth on a rod or a ball, in thick air, and blows.
/// @return ticks at the ends of which it touched
template <class Real>
int abuse_round(const CapsuleDef& rod, double cell, unsigned seed) {
  Random random(seed);
  Particles<Real> cloth =
      make_patch<Real>(cell, Vec3d(-3.4 * cell, rod.radius + 0.01, -3.6 * cell));
  cloth.substeps = 60;
  Contact<Real> contact = cloth.meet({}, {object_of(rod)});
  double least = least_distance(cloth, rod);
  int pressed = 0;
  std::array<Index, 3> held{};
  for (int tick = 0; tick < 60; ++tick) {
    if (tick % 6 == 0) {
      for (Index& i : held) i = random.index(kSide * kSide);
    }
    for (Vec3d& f : cloth.forces) f.setZero();
    for (const Index i : held)
      cloth.forces[static_cast<std::size_t>(i)] =
          -random.uniform(0, 20) * cloth.position(i).normalized();
    for (auto& v : cloth.state.v) v *= Real(0.5);
    if (tick % 20 == 15) {
      for (auto& v : cloth.state.v) v += random.vector(5).template cast<Real>();
    }
    cloth.step(contact);
    const double distance = least_distance(cloth, rod);
    least = std::min(least, distance);
    pressed += distance < 0.0045;
  }
  INFO("radius " << rod.radius << ", cell " << cell);
  CHECK(least > 0);
  return pressed;
}

/// A patch that is drawn into the wedge between the ground and a ball or a rod, which leave it less
/// room the farther it comes. Particles keep a quarter of the thickness of the object, or half of
/// what they have when rows are built, so that no edge or area gets inside between them.
template <class Real>
void abuse_wedged(const CapsuleDef& rod, double cell, double pull, double speed) {
  constexpr double kGround = 2;
  const double from = std::sqrt(2 * rod.radius * 0.012);
  Particles<Real> cloth = make_patch<Real>(cell, Vec3d(-3.4 * cell, 0.005 - rod.radius, from));
  cloth.substeps = 100;
  // It has the last word, as rows of rods are the last to respond.
  const double down = -rod.radius - 5e-4 - kGround;
  const CapsuleDef ground{Vec3d(-0.1, down, 0), Vec3d(0.1, down, 0), kGround};
  Contact<Real> contact = cloth.meet({}, {object_of(rod), {"ground", ground}});
  double least = least_distance(cloth, rod);
  REQUIRE(least > 0);
  double lowest = 1;  // height of a particle over what it keeps
  for (auto& v : cloth.state.v) v = Vec3d(0, 0, -speed).cast<Real>();
  for (int tick = 0; tick < 12; ++tick) {
    for (std::size_t i = 0; i < cloth.forces.size(); ++i)
      cloth.forces[i] = Vec3d(0, 0, tick % 6 < 4 ? -pull : pull);
    cloth.step(contact, [&](const ClothState<Real>& before) {
      least = std::min(least, least_distance(cloth, rod));
      for (Index i = 0; i < kSide * kSide; ++i) {
        const Vec3d was = before.x[static_cast<std::size_t>(i)].template cast<double>();
        const double kept = std::min(0.001, height(rod, was) / 2);
        lowest = std::min(lowest, height(rod, cloth.position(i)) - kept);
      }
    });
  }
  INFO(pull << " N, " << speed << " m/s, radius " << rod.radius << ", cell " << cell);
  CHECK(least < 0.004);  // squeezed
  CHECK(lowest > -7e-5);
  CHECK(least > 0);
}

template <class Real>
void abuse_rounds() {
  for (const double radius : {0.02, 0.1, 0.5}) {
    // The last one is about as coarse as may be where particles alone keep edges off.
    for (const double cell : {0.004, 0.025, 0.065 * std::sqrt(radius)}) {
      for (const double length : {0.0, 0.1}) {
        const CapsuleDef rod{Vec3d(-length, 0, 0), Vec3d(length, 0, 0), radius};
        int pressed = 0, rounds = 0;
        for (const unsigned seed : test::seeds(1, 4)) {
          const test::Repeatable repeatable(seed);
          pressed += abuse_round<Real>(rod, cell, seed);
          ++rounds;
        }
        INFO(radius << " " << cell << " " << length);
        CHECK(pressed >= rounds);
        for (const double pull : {0.02, 0.2}) {
          for (const double speed : {0.0, 5.0, 20.0}) abuse_wedged<Real>(rod, cell, pull, speed);
        }
      }
    }
  }
}

/// A cloth on the ground under a ball that leaves it less than it needs, where rows with the ground
/// outnumber those with the ball and push it up.
template <class Real>
void press_up(double radius, double cell, int grounds, int substeps) {
  Particles<Real> cloth;
  cloth.add_patch(kSide, cell, Vec3d(-3.5 * cell, 0, -3.5 * cell), 1e-3, 50, 10);
  cloth.dashpot = 0.02;
  cloth.substeps = substeps;
  const CapsuleDef ball{Vec3d::Zero(), Vec3d::Zero(), radius};
  PlaneDef ground;
  ground.point = Vec3d(0, -radius - 1.5e-3, 0);
  std::vector<ColliderDef> objects(static_cast<std::size_t>(grounds), {"ground", ground});
  for (std::size_t k = 0; k < objects.size(); ++k) objects[k].name += std::to_string(k);
  objects.push_back(object_of(ball));
  // Its middle lies under the ball, at rest on the ground.
  for (auto& x : cloth.state.x) x[1] = static_cast<Real>(ground.point[1] + 1e-4);
  Contact<Real> contact = cloth.meet({}, objects);
  double least = least_distance(cloth, ball);
  REQUIRE(least > 0);
  for (int tick = 0; tick < 30; ++tick) {
    cloth.step(contact, [&](const ClothState<Real>&) {
      least = std::min(least, least_distance(cloth, ball));
    });
  }
  INFO("radius " << radius << ", cell " << cell << ", " << grounds << " grounds, " << substeps);
  CHECK(least > 0);
}

}  // namespace

TEST_CASE("a cloth pushed up by the ground does not let a ball through its edges and areas") {
  for (const int substeps : {20, 100}) {
    for (const int grounds : {1, 2, 5}) {
      for (const double radius : {0.02, 0.1, 0.5}) {
        for (const double part : {0.03, 0.04, 0.045, 0.05, 0.065}) {
          press_up<double>(radius, part * std::sqrt(radius), grounds, substeps);
          press_up<float>(radius, part * std::sqrt(radius), grounds, substeps);
        }
      }
    }
  }
}

TEST_CASE("a cloth torn about on balls and rods is never inside them, edges and areas neither") {
  SECTION("double") {
    abuse_rounds<double>();
  }
  SECTION("float") {
    abuse_rounds<float>();
  }
}
