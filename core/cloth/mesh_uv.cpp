// Scales, projects and lays out the (u, v) of a mesh.

#include "core/cloth/mesh_uv.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/cloth/constants.h"
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
  const double area = surface_area(cloth.mesh);
  double whole = 0, least = INFINITY;
  for (std::size_t t = 0; !cloth.uv.empty() && t < cloth.mesh.triangles.size(); ++t) {
    const double a = std::abs(doubled_area(corners_of(cloth, t)));
    whole += 0.5 * a;
    least = std::min(least, a);
  }
  const double mean = whole / static_cast<double>(cloth.mesh.triangles.size());
  if (!(whole > 0) || !(least > kLeastUvArea * mean)) return {projected(cloth.mesh), {}};
  MeshMaterial material{cloth.uv, cloth.corner_uv};
  const double scale = std::sqrt(area / whole);
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
