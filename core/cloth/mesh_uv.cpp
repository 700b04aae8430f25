// Scales, projects and lays out the (u, v) of a mesh.

#include "core/cloth/mesh_uv.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/cloth/constants.h"
#include "core/cloth/edge_sides.h"
#include "core/error.h"

namespace weft {
namespace {

using Uv = std::vector<std::array<double, 2>>;

/// (u, v) of a triangle's vertices.
CornerUv of_vertices(const ClothMesh& cloth, std::size_t triangle) {
  CornerUv corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = cloth.uv[static_cast<std::size_t>(cloth.mesh.triangles[triangle][k])];
  return corners;
}

CornerUv corners_of(const ClothMesh& cloth, std::size_t triangle) {
  return cloth.corner_uv.empty() ? of_vertices(cloth, triangle) : cloth.corner_uv[triangle];
}

/// Projects along the axis that most of the surface faces, with v downwards if possible.
Uv projected(const TriangleMesh& mesh) {
  Vec3d faced = Vec3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const auto x = [&](std::size_t k) -> const Vec3d& {
      return mesh.positions[static_cast<std::size_t>(t[k])];
    };
    faced += (x(1) - x(0)).cross(x(2) - x(0)).cwiseAbs();
  }
  Uv uv;
  for (const Vec3d& p : mesh.positions) {
    if (faced[2] >= faced[0] && faced[2] >= faced[1])
      uv.push_back({p[0], -p[1]});
    else if (faced[1] >= faced[0])
      uv.push_back({p[0], p[2]});
    else
      uv.push_back({p[2], -p[1]});
  }
  return uv;
}

double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto x = [&](std::size_t k) -> const Vec3d& {
    return mesh.positions[static_cast<std::size_t>(mesh.triangles[triangle][k])];
  };
  return 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
}

/// Places of a mesh's corners, some of which are holes: triangles without an area.
struct UvHoles {
  std::vector<CornerUv> corners;  ///< by triangle
  std::vector<bool> hole;         ///< likewise
  double area = 0, filled = 0;    ///< of the other triangles, in space and in (u, v)

  explicit UvHoles(const ClothMesh& cloth) {
    double whole = 0;
    for (std::size_t t = 0; t < cloth.mesh.triangles.size(); ++t) {
      corners.push_back(corners_of(cloth, t));
      whole += std::abs(doubled_area(corners[t]));
    }
    const double least = kLeastUvArea * whole / static_cast<double>(corners.size());
    for (std::size_t t = 0; t < corners.size(); ++t) {
      const double own = std::abs(doubled_area(corners[t]));
      hole.push_back(!(own > least));
      if (hole[t]) continue;
      area += area_of(cloth.mesh, t);
      filled += 0.5 * own;
    }
  }

  bool any() const { return std::find(hole.begin(), hole.end(), true) != hole.end(); }
};

/// Number of a corner in its triangle, 0 to 2.
std::size_t corner_of(const Triangle& triangle, Index particle) {
  return static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), particle) -
                                  triangle.begin());
}

/// Lays a triangle out beside its neighbour at an edge, with its own shape and at the scale that
/// the edge has in the neighbour.
/// @param side  of the edge that the triangle is on, 0 or 1
void continue_beyond(const EdgeSides& edge, std::size_t side, const TriangleMesh& mesh,
                     std::vector<CornerUv>& corners) {
  const auto own = static_cast<std::size_t>(edge.triangle[side]),
             other = static_cast<std::size_t>(edge.triangle[1 - side]);
  const auto there = [&](Index i) {
    const auto& p = corners[other][corner_of(mesh.triangles[other], i)];
    return Eigen::Vector2d(p[0], p[1]);
  };
  const auto here = [&](Index i) -> const Vec3d& {
    return mesh.positions[static_cast<std::size_t>(i)];
  };
  const auto [a, b] = edge.ends;
  const Vec3d along = here(b) - here(a), to = here(edge.opposite[side]) - here(a);
  const double foot = to.dot(along) / along.squaredNorm(),
               height = along.cross(to).norm() / along.squaredNorm();
  const Eigen::Vector2d start = there(a), line = there(b) - start;
  Eigen::Vector2d out(-line[1], line[0]);
  if (out.dot(there(edge.opposite[1 - side]) - start) > 0) out = -out;
  const auto put = [&](Index i, const Eigen::Vector2d& place) {
    corners[own][corner_of(mesh.triangles[own], i)] = {place[0], place[1]};
  };
  put(a, start);
  put(b, start + line);
  put(edge.opposite[side], start + foot * line + height * out);
}

/// Gives holes the places that continue their neighbours. Holes that no others are connected to
/// stay.
/// @returns whether none is left
bool fill(const TriangleMesh& mesh, UvHoles& uv) {
  const std::vector<EdgeSides> edges = sides_of(mesh.triangles);
  const auto edges_of = edges_of_triangles(edges, mesh.triangles);
  std::vector<Index> placed;
  for (std::size_t t = 0; t < uv.hole.size(); ++t) {
    if (!uv.hole[t]) placed.push_back(static_cast<Index>(t));
  }
  for (std::size_t n = 0; n < placed.size(); ++n) {  // it grows
    const Index triangle = placed[n];
    for (const Index e : edges_of[static_cast<std::size_t>(triangle)]) {
      const EdgeSides& edge = edges[static_cast<std::size_t>(e)];
      const std::size_t side = edge.triangle[0] == triangle ? 1 : 0;
      const Index beyond = edge.triangle[side];
      if (beyond == kNone || !uv.hole[static_cast<std::size_t>(beyond)]) continue;
      continue_beyond(edge, side, mesh, uv.corners);
      uv.hole[static_cast<std::size_t>(beyond)] = false;
      placed.push_back(beyond);
    }
  }
  return placed.size() == mesh.triangles.size();
}

/// Gives vertices that only holes meet at the place of the first one's corner.
void place_inner_vertices(const TriangleMesh& mesh, const std::vector<bool>& hole,
                          MeshMaterial& material) {
  std::vector<bool> known(mesh.positions.size(), false);
  for (const bool holes : {false, true}) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3 && hole[t] == holes; ++k) {
        const auto i = static_cast<std::size_t>(mesh.triangles[t][k]);
        if (holes && !known[i]) material.of_vertices[i] = material.of_corners[t][k];
        known[i] = true;
      }
    }
  }
}

DefinitionError not_laid_out(std::size_t triangle, const char* with, const char* hint) {
  return {"cloth.rest_shape", "uv", std::string("placed where a triangle has ") + with,
          "triangle " + std::to_string(triangle) + hint};
}

}  // namespace

double doubled_area(const CornerUv& corners) {
  const auto &a = corners[0], &b = corners[1], &c = corners[2];
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

void refuse_other_uv(const ClothMesh& cloth) {
  const std::size_t vertices = cloth.mesh.positions.size();
  if (!cloth.uv.empty() && cloth.uv.size() != vertices)
    throw DefinitionError("cloth.mesh.uv", std::to_string(cloth.uv.size()) + " pairs",
                          std::to_string(vertices) + ", one a vertex, or none");
  const std::size_t triangles = cloth.uv.empty() ? 0 : cloth.mesh.triangles.size();
  if (!cloth.corner_uv.empty() && cloth.corner_uv.size() != triangles)
    throw DefinitionError("cloth.mesh.corner_uv",
                          std::to_string(cloth.corner_uv.size()) + " triangles",
                          std::to_string(triangles) + ", as the mesh with uv has, or none");
}

bool has_seams(const ClothMesh& cloth) {
  for (std::size_t t = 0; t < cloth.corner_uv.size(); ++t) {
    if (cloth.corner_uv[t] != of_vertices(cloth, t)) return true;
  }
  return false;
}

MeshMaterial material_of(const ClothMesh& cloth) {
  if (cloth.uv.empty()) return {projected(cloth.mesh), {}};
  UvHoles uv(cloth);
  const double scale = std::sqrt(uv.area / uv.filled);
  MeshMaterial material{cloth.uv, cloth.corner_uv};
  if (uv.any()) {
    const bool most = uv.area > kLeastUvPart * surface_area(cloth.mesh);
    const std::vector<bool> hole = uv.hole;
    if (!most || !fill(cloth.mesh, uv)) return {projected(cloth.mesh), {}};
    material.of_corners = uv.corners;
    place_inner_vertices(cloth.mesh, hole, material);
  }
  for (auto& point : material.of_vertices) {
    for (double& x : point) x *= scale;
  }
  for (CornerUv& corners : material.of_corners) {
    for (auto& point : corners) {
      for (double& x : point) x *= scale;
    }
  }
  return material;
}

ClothDef laid_out(const ClothDef& def) {
  assert(def.mesh && !has_seams(*def.mesh));
  ClothDef flat = def;
  const ClothMesh& cloth = *def.mesh;
  const std::size_t count = cloth.mesh.triangles.size();
  double whole = 0;
  for (std::size_t t = 0; t < count; ++t) whole += doubled_area(of_vertices(cloth, t)) / 2;
  const double mean = whole / static_cast<double>(count);
  for (std::size_t t = 0; t < count; ++t) {
    const double area = doubled_area(of_vertices(cloth, t)) / 2;
    if (mean != 0 && area / mean > kLeastUvArea) continue;
    throw not_laid_out(t, "no area in uv, or is turned over", " is; unfold the uv");
  }
  for (std::size_t i = 0; i < cloth.uv.size(); ++i)
    flat.mesh->mesh.positions[i] = Vec3d(cloth.uv[i][0], cloth.uv[i][1], 0);
  return flat;
}

MeshMaterial pieces_of(const ClothMesh& cloth) {
  assert(has_seams(cloth));
  double whole = 0;
  for (const CornerUv& corners : cloth.corner_uv) whole += std::abs(doubled_area(corners));
  const double least = kLeastUvArea * whole / static_cast<double>(cloth.corner_uv.size());
  for (std::size_t t = 0; t < cloth.corner_uv.size(); ++t) {
    if (std::abs(doubled_area(cloth.corner_uv[t])) > least) continue;
    throw not_laid_out(t, "no area in uv", "; unfold the uv");
  }
  return {cloth.uv, cloth.corner_uv};
}

}  // namespace weft
