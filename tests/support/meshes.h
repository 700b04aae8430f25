#pragma once

#include <cmath>

#include "core/geometry/triangle_mesh.h"

namespace weft::test {

/// Möller and Trumbore's test of segment pq against triangle abc, in double; border counts as hit.
inline bool pierces(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b,
                    const Vec3d& c) {
  const Vec3d e1 = b - a, e2 = c - a, d = q - p, h = d.cross(e2), s = p - a, k = s.cross(e1);
  const double det = e1.dot(h);
  if (std::abs(det) < 1e-30) return false;
  const double u = s.dot(h) / det, v = d.dot(k) / det, t = e2.dot(k) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

/// Whether a segment pierces any triangle of a mesh, by trying all.
inline bool pierces(const Vec3d& p, const Vec3d& q, const TriangleMesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t k) { return mesh.positions[static_cast<std::size_t>(t[k])]; };
    if (pierces(p, q, at(0), at(1), at(2))) return true;
  }
  return false;
}

/// Whether an edge of the mesh pierces triangle abc.
inline bool mesh_pierces(const TriangleMesh& mesh, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  for (const MeshEdge& e : edges_of(mesh)) {
    if (pierces(mesh.positions[static_cast<std::size_t>(e.a)],
                mesh.positions[static_cast<std::size_t>(e.b)], a, b, c))
      return true;
  }
  return false;
}

/// A closed plate, wide in x and z, its upper face at y = 0.
inline TriangleMesh plate(double half_width, double thickness) {
  TriangleMesh mesh = box_mesh(Vec3d(half_width, thickness / 2, half_width));
  for (Vec3d& p : mesh.positions) p[1] -= thickness / 2;
  return mesh;
}

/// An open square of two triangles in the plane y = 0, facing up.
inline TriangleMesh sheet(double half_width) {
  const double w = half_width;
  return {{{-w, 0, -w}, {-w, 0, w}, {w, 0, w}, {w, 0, -w}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A blade along z whose edge, up at y = 0, has the given full angle [rad].
inline TriangleMesh blade(double angle, double depth, double half_length) {
  const double w = depth * std::tan(angle / 2), l = half_length;
  return {
      {{0, 0, -l}, {0, 0, l}, {-w, -depth, -l}, {-w, -depth, l}, {w, -depth, -l}, {w, -depth, l}},
      {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {2, 4, 5}, {2, 5, 3}, {0, 4, 2}, {1, 3, 5}}};
}

/// A needle with its tip at the origin, pointing up.
inline TriangleMesh needle(double radius, double length, int sides) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, -length, 0}};
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * 3.14159265358979323846 * k / sides;
    mesh.positions.emplace_back(radius * std::sin(angle), -length, radius * std::cos(angle));
    const Index a = 2 + k, b = 2 + (k + 1) % sides;
    mesh.triangles.push_back({0, a, b});
    mesh.triangles.push_back({1, b, a});
  }
  return mesh;
}

}  // namespace weft::test
