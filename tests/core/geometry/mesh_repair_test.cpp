#include "core/geometry/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/support/meshes.h"

using namespace weft;

namespace {

TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.positions == b.positions;
}

/// A box with a corner more on the middle of one of its edges, which a triangle without area joins
/// to the face on one side of it, as programs leave it that cut curved surfaces into triangles.
TriangleMesh box_with_flat_triangle(int corners) {
  TriangleMesh mesh = box_mesh(Vec3d(0.5, 1, 1.5));
  // The side from 0 to 2 of its first triangle 0, 2, 3; the triangle 0, 6, 2 on its other side
  // stays.
  REQUIRE(mesh.triangles.front() == Triangle{0, 2, 3});
  mesh.triangles.erase(mesh.triangles.begin());
  std::vector<Index> row = {0};
  for (int k = 1; k <= corners; ++k) {
    mesh.positions.push_back(mesh.positions[0] +
                             (mesh.positions[2] - mesh.positions[0]) * k / (corners + 1.0));
    row.push_back(static_cast<Index>(mesh.positions.size()) - 1);
  }
  row.push_back(2);
  for (std::size_t k = 0; k + 1 < row.size(); ++k)
    mesh.triangles.push_back({row[k], row[k + 1], 3});
  // A fan of flat triangles closes the row towards the side 0, 2.
  for (std::size_t k = 1; k + 1 < row.size(); ++k)
    mesh.triangles.push_back({row[0], row[k + 1], row[k]});
  return mesh;
}

}  // namespace

TEST_CASE("a closed mesh that faces inwards is turned, and is then what it was before") {
  for (const double far : {0.0, 900.0}) {
    TriangleMesh box = box_mesh(Vec3d(0.01, 0.02, 0.03));
    for (Vec3d& p : box.positions) p += Vec3d(far, -far, far);
    TriangleMesh inward = turned_inside_out(box);
    const MeshRepair done = repair(inward);
    CHECK(done.turned);
    CHECK(done.dropped == 0);
    CHECK(same(inward, box));
    CHECK_FALSE(repair(inward).turned);
  }
}

TEST_CASE("a mesh that faces outwards, is open, or encloses nothing stays as it is") {
  TriangleMesh open = turned_inside_out(box_mesh(Vec3d(1, 1, 1)));
  open.triangles.pop_back();
  const TriangleMesh one = test::sheet(1);
  TriangleMesh rounded_away = turned_inside_out(box_mesh(Vec3d(0.3, 1e-9, 0.3)));
  for (Vec3d& p : rounded_away.positions) p += Vec3d(0.1, 0.7, 0.9);
  // Both faces of a triangle in one place.
  const TriangleMesh two_faced{{{0.1, 0.7, 0.9}, {1.3, 0.2, 0.4}, {0.5, 0.6, 0.1}},
                               {{0, 1, 2}, {0, 2, 1}}};
  REQUIRE(is_closed(two_faced));
  for (const TriangleMesh& mesh :
       {box_mesh(Vec3d(1, 2, 3)), test::plate(1, 1e-4), one, open, two_faced, rounded_away}) {
    TriangleMesh repaired = mesh;
    const MeshRepair done = repair(repaired);
    CHECK_FALSE(done.turned);
    CHECK(done.dropped == 0);
    CHECK(same(repaired, mesh));
  }
}

TEST_CASE("a thin plate that faces inwards is turned all the same") {
  TriangleMesh plate = turned_inside_out(test::plate(1, 1e-3));
  CHECK(repair(plate).turned);
}

TEST_CASE("triangles with a corner twice go, and a closed mesh stays closed without them") {
  TriangleMesh mesh = box_mesh(Vec3d(0.5, 1, 1.5));
  const TriangleMesh before = mesh;
  mesh.triangles.insert(mesh.triangles.begin() + 3, {1, 1, 5});
  mesh.triangles.push_back({4, 4, 4});
  const MeshRepair done = repair(mesh);
  CHECK(done.dropped == 2);
  CHECK(done.triangles == 14);
  CHECK_FALSE(done.opened);
  CHECK(same(mesh, before));
}

TEST_CASE(
    "flat triangles along an edge go, and the surface stays closed with its volume and area") {
  for (const int corners : {1, 2, 5, 20}) {
    CAPTURE(corners);
    TriangleMesh mesh = box_with_flat_triangle(corners);
    REQUIRE(is_closed(mesh));
    REQUIRE_THROWS_AS(validate(mesh, ""), DefinitionError);
    for (const bool inside_out : {false, true}) {
      TriangleMesh repaired = inside_out ? turned_inside_out(mesh) : mesh;
      const MeshRepair done = repair(repaired);
      CHECK(done.dropped >= static_cast<std::size_t>(corners));
      CHECK(done.turned == inside_out);
      CHECK_FALSE(done.opened);
      CHECK_NOTHROW(validate(repaired, ""));
      CHECK(is_closed(repaired));
      CHECK(enclosed_volume(repaired) == Approx(6).epsilon(1e-12));
      CHECK(surface_area(repaired) == Approx(22).epsilon(1e-12));
    }
  }
}

TEST_CASE("where a flat triangle cannot be taken out without a gap, that is told") {
  // A sheet and a flat triangle that hangs on one of its sides.
  TriangleMesh mesh = test::sheet(1);
  mesh.positions.emplace_back(0, 0, 0);
  mesh.triangles.push_back({0, 4, 2});
  const MeshRepair done = repair(mesh);
  CHECK(done.dropped == 1);
  CHECK_FALSE(done.opened);  // it was not closed before
  CHECK(same({{}, mesh.triangles}, {{}, test::sheet(1).triangles}));
  // A closed surface of nothing but flat triangles is none.
  TriangleMesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  CHECK(repair(line).opened);
  CHECK_THROWS_AS(validate(line, ""), DefinitionError);
}

TEST_CASE("what validation refuses by name is left to it") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (TriangleMesh mesh : {TriangleMesh{}, TriangleMesh{{{0, 0, 0}}, {}},
                            TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}},
                            TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, -1}}},
                            TriangleMesh{{{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}}) {
    repair(mesh);
    CHECK_THROWS_AS(validate(mesh, "mesh."), DefinitionError);
  }
}
