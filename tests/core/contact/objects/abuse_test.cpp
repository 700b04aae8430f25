#include <catch2/catch.hpp>

#include "core/contact/objects/contact.h"
#include "core/geometry/aabb.h"
#include "core/scenes/dress_form.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"
#include "tests/support/seeded_random.h"

// A cloth that is torn about at random around objects, checked pair by pair without any hierarchy.

using namespace weft;
using test::Particles;
using test::Random;

namespace {

constexpr Index kSide = 8;

/// A square patch with stretch and shear springs in the plane y = height.
template <class Real>
Particles<Real> make_patch(double cell, double height) {
  Particles<Real> cloth;
  cloth.add_patch(kSide, cell, Vec3d(-3.4 * cell, height, -3.6 * cell), 1e-4, 200, 40);
  cloth.dashpot = 0.02;
  return cloth;
}

/// Crossing pairs of cloth edge and mesh triangle, and of mesh edge and cloth triangle.
template <class Real>
int count_crossings(const Particles<Real>& cloth, const TriangleMesh& mesh,
                    const std::vector<MeshEdge>& mesh_edges) {
  const auto at = [&](Index i) { return mesh.positions[static_cast<std::size_t>(i)]; };
  Aabb<double> bounds;
  for (const auto& x : cloth.state.x) bounds.add(x.template cast<double>());
  int count = 0;
  for (const Triangle& t : mesh.triangles) {
    Aabb<double> box;
    for (const Index i : t) box.add(at(i));
    if (!box.overlaps(bounds)) continue;
    for (const Edge& e : cloth.edges)
      count +=
          test::pierces(cloth.position(e[0]), cloth.position(e[1]), at(t[0]), at(t[1]), at(t[2]));
  }
  for (const MeshEdge& e : mesh_edges) {
    Aabb<double> box;
    box.add(at(e.a));
    box.add(at(e.b));
    if (!box.overlaps(bounds)) continue;
    for (const Triangle& t : cloth.triangles)
      count += test::pierces(at(e.a), at(e.b), cloth.position(t[0]), cloth.position(t[1]),
                             cloth.position(t[2]));
  }
  return count;
}

/// Hands of 50 N at three random particles, moved every few ticks, and now and then all velocities
/// thrown about by 20 m/s.
template <class Real>
void abuse(const TriangleMesh& mesh, double cell, const Vec3d& goal, unsigned seed) {
  constexpr int kTicks = 60;
  Random random(seed);
  Particles<Real> cloth = make_patch<Real>(cell, 0.05);
  cloth.substeps = 60;
  Contact<Real> contact = cloth.meet({}, {{"object", MeshDef{mesh}}});
  const std::vector<MeshEdge> mesh_edges = edges_of(mesh);
  REQUIRE(count_crossings(cloth, mesh, mesh_edges) == 0);
  int crossed_ticks = 0, first = -1;
  for (int tick = 0; tick < kTicks; ++tick) {
    if (tick % 6 == 3) {
      for (Vec3d& f : cloth.forces) f.setZero();
      for (int hand = 0; hand < 3; ++hand) {
        const Index i = random.index(kSide * kSide);
        // Towards the far side of the object as often as not.
        const Vec3d aim = goal + random.vector(0.1) - cloth.position(i);
        cloth.forces[static_cast<std::size_t>(i)] = aim.normalized() * random.uniform(0, 50);
      }
    }
    if (tick % 20 == 15) {
      for (auto& v : cloth.state.v) v += random.vector(20).template cast<Real>();
    }
    cloth.step(contact);
    const int crossings = count_crossings(cloth, mesh, mesh_edges);
    if (crossings > 0 && first < 0) first = tick;
    crossed_ticks += crossings > 0;
  }
  for (const auto& x : cloth.state.x) REQUIRE(x.allFinite());
  INFO("first tick " << first << " of " << crossed_ticks);
  CHECK(crossed_ticks == 0);
}

template <class Real>
void abuse_all(const TriangleMesh& mesh, double cell, const Vec3d& goal = Vec3d::Zero()) {
  for (const unsigned seed : test::seeds(1, 4)) {
    const test::Repeatable repeatable(seed);
    abuse<Real>(mesh, cell, goal, seed);
  }
}

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by) {
  for (Vec3d& p : mesh.positions) p += by;
  return mesh;
}

}  // namespace

TEST_CASE("a cloth torn about by hands of 50 N and blows of 20 m/s crosses no object") {
  const TriangleMesh box = box_mesh(Vec3d(0.06, 0.03, 0.05)), plate = test::plate(0.06, 1e-3);
  const TriangleMesh sheet = test::sheet(0.06), knife = test::blade(0.035, 0.1, 0.1);
  const TriangleMesh needle = test::needle(0.005, 0.2, 5);
  SECTION("box") {
    abuse_all<double>(box, 0.025);
  }
  SECTION("box, float") {
    abuse_all<float>(box, 0.025);
  }
  SECTION("plate of 1 mm") {
    abuse_all<double>(plate, 0.025);
  }
  SECTION("plate of 1 mm, float") {
    abuse_all<float>(plate, 0.025);
  }
  SECTION("open sheet") {
    abuse_all<double>(sheet, 0.025);
  }
  SECTION("open sheet, float") {
    abuse_all<float>(sheet, 0.025);
  }
  SECTION("knife of 2 degrees") {
    abuse_all<double>(knife, 0.025);
  }
  SECTION("knife of 2 degrees, float") {
    abuse_all<float>(knife, 0.025);
  }
  SECTION("needle") {
    abuse_all<double>(needle, 0.025);
  }
  SECTION("needle, float") {
    abuse_all<float>(needle, 0.025);
  }
}

TEST_CASE("a cloth torn about on the dressmaker's form crosses it nowhere") {
  const TriangleMesh form = make_dress_form();
  SECTION("pole") {
    abuse_all<float>(moved(form, Vec3d(0.21, -0.4, 0)), 0.05, Vec3d(0.25, 0, 0));
  }
  SECTION("shoulders") {
    abuse_all<float>(moved(form, Vec3d(0, -1.55, 0)), 0.05);
  }
  SECTION("bust") {
    abuse_all<float>(moved(form, Vec3d(0, -1.0, -0.37)), 0.05, Vec3d(0, 0.1, -0.37));
  }
}
