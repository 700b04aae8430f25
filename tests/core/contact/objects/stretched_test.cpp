#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "core/contact/objects/contact.h"
#include "core/geometry/distance.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"

// Between particles that keep off it a smooth object rises little at rest, and much when these are
// pulled apart. And where two objects meet, what one pushes out the other takes.

using namespace weft;
using test::Particles;

namespace {

constexpr double kRadius = 0.2, kSide = 0.04;

/// A ball about the origin of flat faces, whose ridges turn by 11 degrees.
TriangleMesh faceted_ball() {
  constexpr Index kRound = 32, kDown = 16;
  constexpr double kPi = 3.14159265358979323846;
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, kRadius, 0);
  for (Index row = 1; row < kDown; ++row) {
    const double polar = kPi * row / kDown;
    for (Index k = 0; k < kRound; ++k) {
      const double around = 2 * kPi * k / kRound;
      mesh.positions.emplace_back(kRadius * std::sin(polar) * std::cos(around),
                                  kRadius * std::cos(polar),
                                  kRadius * std::sin(polar) * std::sin(around));
    }
  }
  mesh.positions.emplace_back(0, -kRadius, 0);
  const auto last = static_cast<Index>(mesh.positions.size() - 1);
  const auto at = [&](Index row, Index k) { return 1 + (row - 1) * kRound + k % kRound; };
  for (Index k = 0; k < kRound; ++k) {
    mesh.triangles.push_back({0, at(1, k + 1), at(1, k)});
    mesh.triangles.push_back({last, at(kDown - 1, k), at(kDown - 1, k + 1)});
    for (Index row = 1; row + 1 < kDown; ++row) {
      mesh.triangles.push_back({at(row, k), at(row, k + 1), at(row + 1, k)});
      mesh.triangles.push_back({at(row, k + 1), at(row + 1, k + 1), at(row + 1, k)});
    }
  }
  return mesh;
}

/// Particles on a small circle over the ball, joined by weak springs, which are pulled down and
/// outward until they hang about it.
template <class Real>
Particles<Real> weak_patch(int corners, double pull) {
  Particles<Real> cloth;
  for (int k = 0; k < corners; ++k) {
    const double angle = 0.1 + 2 * 3.14159265358979 * k / corners;
    const Vec3d out(std::cos(angle), 0, std::sin(angle));
    cloth.add(out * kSide / 2 + Vec3d(0.01, kRadius + 0.01, 0));
  }
  if (corners == 2)
    cloth.join(0, 1, 20);
  else
    cloth.add_triangle(0, 1, 2, 6);
  cloth.dashpot = 0.02;
  cloth.substeps = 100;
  for (int k = 0; k < corners; ++k) {
    const double angle = 0.1 + 2 * 3.14159265358979 * k / corners;
    cloth.forces[static_cast<std::size_t>(k)] =
        pull * Vec3d(std::cos(angle), -1, std::sin(angle)).normalized();
  }
  return cloth;
}

/// Least distance of the edge or the triangle from the origin [m].
template <class Real>
double from_origin(const Particles<Real>& cloth) {
  const Vec3d o = Vec3d::Zero(), a = cloth.position(0), b = cloth.position(1);
  if (cloth.triangles.empty()) return (a + (b - a) * closest_on_segment(o, a, b)).norm();
  return closest_on_triangle(o, a, b, cloth.position(2)).point.norm();
}

/// Crossings of its edges and area with the mesh.
template <class Real>
int crossings(const Particles<Real>& cloth, const TriangleMesh& mesh) {
  int count = 0;
  for (const Edge& e : cloth.edges)
    count += test::pierces(cloth.position(e[0]), cloth.position(e[1]), mesh);
  for (const Triangle& t : cloth.triangles)
    count +=
        test::mesh_pierces(mesh, cloth.position(t[0]), cloth.position(t[1]), cloth.position(t[2]));
  return count;
}

template <class Real>
void check_stretched(int corners) {
  const TriangleMesh faceted = faceted_ball();
  for (const double pull : {0.5, 3.0, 20.0}) {
    for (const bool flat : {false, true}) {
      Particles<Real> cloth = weak_patch<Real>(corners, pull);
      ColliderDef ball{"ball", SphereDef{Vec3d::Zero(), kRadius}};
      if (flat) ball.shape = MeshDef{faceted};
      Contact<Real> contact = cloth.meet({}, {ball});
      int crossed = 0;
      double nearest = 1, longest = 0;
      for (int tick = 0; tick < 30; ++tick) {
        cloth.step(contact);
        if (flat) crossed += crossings(cloth, faceted);
        nearest = std::min(nearest, from_origin(cloth));
        longest = std::max(longest, (cloth.position(0) - cloth.position(1)).norm());
      }
      INFO(corners << " corners, " << pull << " N, " << (flat ? "mesh" : "ball"));
      CHECK(longest > 1.4 * kSide);
      CHECK(crossed == 0);
      if (!flat) CHECK(nearest > kRadius - 1e-6);
    }
  }
}

}  // namespace

TEST_CASE("an edge pulled to many times its length does not pass through a smooth object") {
  check_stretched<double>(2);
  check_stretched<float>(2);
}

TEST_CASE("a triangle pulled to many times its size does not pass through a smooth object") {
  check_stretched<double>(3);
  check_stretched<float>(3);
}

namespace {

/// A particle drawn into the wedge between the ground and balls that nearly stand on it, all in one
/// place, so that more push it down than up.
template <class Real>
void check_wedge(double pull, int balls) {
  Particles<Real> grain;
  grain.add(Vec3d(0.09, 0.008, 0.01));
  grain.substeps = 100;
  grain.forces[0] = Vec3d(-pull, 0, 0);
  const SphereDef ball{Vec3d(0, kRadius + 5e-4, 0), kRadius};
  std::vector<ColliderDef> objects = {{"ground", PlaneDef{}}};
  for (int k = 0; k < balls; ++k) objects.push_back({"ball" + std::to_string(k), ball});
  Contact<Real> contact = grain.meet({}, objects);
  double deepest = 0;
  for (int tick = 0; tick < 30; ++tick) {
    grain.step(contact);
    deepest = std::max(deepest, contact.deepest_penetration(grain.state.x));
  }
  INFO(pull << " N, " << balls << " balls");
  CHECK(grain.position(0)[0] < 0.07);  // it went in
  CHECK(deepest < 1e-6);
}

}  // namespace

TEST_CASE("what is drawn between objects at rest is not pushed out of one into the other") {
  for (const double pull : {0.1, 5.0, 50.0}) {
    for (const int balls : {1, 10}) {
      check_wedge<double>(pull, balls);
      check_wedge<float>(pull, balls);
    }
  }
}
