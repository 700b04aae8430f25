#include "core/geometry/triangle_mesh.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "core/error.h"

using namespace weft;

namespace {

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// The field that validation complains about, or nothing.
std::string refused(const TriangleMesh& mesh) {
  try {
    validate(mesh, "mesh.");
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return {};
}

}  // namespace

TEST_CASE("area and volume of a box and of a tetrahedron") {
  const TriangleMesh box = box_mesh(Vec3d(0.5, 1, 1.5));
  CHECK(surface_area(box) == Approx(2 * (1 * 2 + 2 * 3 + 1 * 3)).epsilon(1e-14));
  CHECK(enclosed_volume(box) == Approx(6).epsilon(1e-14));
  CHECK(is_closed(box));
  CHECK(edges_of(box).size() == 18);
  CHECK(enclosed_volume(tetrahedron()) == Approx(1.0 / 6).epsilon(1e-14));
  CHECK(surface_area(tetrahedron()) == Approx(1.5 + std::sqrt(3) / 2).epsilon(1e-14));
}

TEST_CASE("volume does not depend on where the mesh stands") {
  TriangleMesh mesh = tetrahedron();
  for (Vec3d& p : mesh.positions) p += Vec3d(10, -20, 30);
  CHECK(enclosed_volume(mesh) == Approx(1.0 / 6).epsilon(1e-10));
}

TEST_CASE("a surface is closed only if each edge is run through once in either direction") {
  TriangleMesh open = tetrahedron();
  open.triangles.pop_back();
  CHECK_FALSE(is_closed(open));
  TriangleMesh turned = tetrahedron();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  CHECK_FALSE(is_closed(turned));
  TriangleMesh doubled = tetrahedron();
  doubled.triangles.push_back(doubled.triangles[0]);
  CHECK_FALSE(is_closed(doubled));
  CHECK_FALSE(is_closed(TriangleMesh{}));
}

TEST_CASE("every edge is listed once with the triangles beside it") {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  int rims = 0;
  for (const MeshEdge& e : edges_of(mesh)) {
    CHECK(e.a < e.b);
    for (const Index t : e.triangle) {
      if (t == kNone) {
        ++rims;
        continue;
      }
      const Triangle& corners = mesh.triangles[static_cast<std::size_t>(t)];
      CHECK(std::count(corners.begin(), corners.end(), e.a) == 1);
      CHECK(std::count(corners.begin(), corners.end(), e.b) == 1);
    }
  }
  CHECK(edges_of(mesh).size() == 6);
  CHECK(rims == 3);
}

TEST_CASE("vertex normals of a box point along its diagonals, however its faces are cut") {
  for (const Vec3d& half : {Vec3d(1, 1, 1), Vec3d(0.2, 1, 3)}) {
    const TriangleMesh box = box_mesh(half);
    const std::vector<Vec3d> normals = vertex_normals(box);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const Vec3d wanted = box.positions[i].cwiseQuotient(half) / std::sqrt(3);
      CHECK((normals[i] - wanted).norm() < 1e-12);
    }
  }
}

TEST_CASE("a mesh that cannot be used is refused by the name of its entry") {
  CHECK(refused(tetrahedron()).empty());
  CHECK(refused(TriangleMesh{}) == "mesh.positions");
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.clear();
  CHECK(refused(mesh) == "mesh.triangles");
  mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  CHECK(refused(mesh) == "mesh.triangles[2]");
  mesh.triangles[2][1] = -1;
  CHECK(refused(mesh) == "mesh.triangles[2]");
  mesh = tetrahedron();
  mesh.triangles[1] = {0, 1, 1};
  CHECK(refused(mesh) == "mesh.triangles[1]");
  mesh = tetrahedron();
  mesh.positions[3][2] = std::nan("");
  CHECK(refused(mesh) == "mesh.positions[3][2]");
  mesh.positions[3][2] = 1e9;
  CHECK(refused(mesh) == "mesh.positions[3][2]");
}
