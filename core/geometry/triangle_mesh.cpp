// Edges, normals, measures and checks of triangle meshes.

#include "core/geometry/triangle_mesh.h"

#include <cassert>
#include <map>

#include "core/definition.h"
#include "core/error.h"
#include "core/geometry/constants.h"
#include "core/geometry/triangle_sides.h"
#include "core/math/angle.h"

namespace weft {
namespace {

const Vec3d& corner(const TriangleMesh& mesh, Index triangle, std::size_t k) {
  assert(static_cast<std::size_t>(triangle) < mesh.triangles.size() && k < 3);
  const Index vertex = mesh.triangles[static_cast<std::size_t>(triangle)][k];
  assert(static_cast<std::size_t>(vertex) < mesh.positions.size());
  return mesh.positions[static_cast<std::size_t>(vertex)];
}

Vec3d doubled_normal(const TriangleMesh& mesh, Index t) {
  return (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0));
}

}  // namespace

TriangleMesh placed(TriangleMesh mesh, const MeshPlacement& placement) {
  const Eigen::Quaterniond turn = placement.orientation.normalized();
  for (Vec3d& p : mesh.positions) p = placement.position + turn * (p * placement.scale);
  return mesh;
}

std::vector<MeshEdge> edges_of(const TriangleMesh& mesh) {
  std::vector<MeshEdge> edges;
  for (const TriangleSide& side : sorted_sides(mesh.triangles)) {
    if (edges.empty() || Edge{edges.back().a, edges.back().b} != side.ends)
      edges.push_back({side.ends[0], side.ends[1], {side.triangle, kNone}});
    else if (edges.back().triangle[1] == kNone)
      edges.back().triangle[1] = side.triangle;
  }
  return edges;
}

bool is_closed(const TriangleMesh& mesh) {
  std::map<Edge, int> directed;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [ends, count] : directed) {
    const auto back = directed.find({ends[1], ends[0]});
    if (count != 1 || back == directed.end() || back->second != 1) return false;
  }
  return !directed.empty();
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += 0.5 * doubled_normal(mesh, static_cast<Index>(t)).norm();
  return sum;
}

double enclosed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto at = [&](std::size_t k) -> Vec3d {
      return corner(mesh, static_cast<Index>(t), k) - mesh.positions.front();
    };
    sum += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return sum;
}

Vec3d unit_normal(const TriangleMesh& mesh, Index triangle) {
  const Vec3d n = doubled_normal(mesh, triangle);
  const double length = n.norm();
  return length > 0 ? (n / length).eval() : Vec3d::Zero().eval();
}

std::vector<Vec3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3d> normals(mesh.positions.size(), Vec3d::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto i = static_cast<Index>(t);
    const Vec3d n = unit_normal(mesh, i);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d u = corner(mesh, i, (k + 1) % 3) - corner(mesh, i, k);
      const Vec3d v = corner(mesh, i, (k + 2) % 3) - corner(mesh, i, k);
      const double angle = angle_of(u.cross(v).norm(), u.dot(v));
      normals[static_cast<std::size_t>(mesh.triangles[t][k])] += n * angle;
    }
  }
  for (Vec3d& n : normals) {
    const double length = n.norm();
    if (length > 0) n /= length;
  }
  return normals;
}

void validate(const TriangleMesh& mesh, const std::string& path) {
  const auto count = [&](const char* name, std::size_t value, std::size_t most) {
    check_field(path, {name, 1, static_cast<double>(most), "", "size of the mesh"},
                static_cast<double>(value));
  };
  count("positions", mesh.positions.size(), kMostMeshVertices);
  count("triangles", mesh.triangles.size(), kMostMeshTriangles);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    check_field(path + "positions[" + std::to_string(i) + "]", {"", -1000, 1000, "m", "a vertex"},
                mesh.positions[i]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::string name = path + "triangles[" + std::to_string(t) + "]";
    for (const Index i : mesh.triangles[t])
      check_field(
          name, {"", 0, static_cast<double>(mesh.positions.size()) - 1, "", "a vertex's index"}, i);
    if (!(doubled_normal(mesh, static_cast<Index>(t)).norm() > kLeastDoubledArea))
      throw DefinitionError(name, "without area", "three corners that span an area",
                            "remove degenerate triangles");
  }
}

TriangleMesh box_mesh(const Vec3d& half) {
  assert(half.minCoeff() > 0);
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.emplace_back(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1],
                                k & 4 ? half[2] : -half[2]);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

}  // namespace weft
