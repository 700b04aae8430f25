#pragma once

#include <cmath>
#include <numbers>

#include "core/geometry/triangle_mesh.h"

// Cylinders about the y axis and strips of them, as meshes.

namespace weft::test {

/// @param angle  that the strip covers [rad]
inline TriangleMesh rolled(double radius, double angle, Index columns, Index rows, double from,
                           double to) {
  TriangleMesh mesh;
  for (Index r = 0; r < rows; ++r) {
    for (Index c = 0; c <= columns; ++c) {
      const double turn = angle * c / columns;
      mesh.positions.emplace_back(radius * std::cos(turn), from + (to - from) * r / (rows - 1),
                                  radius * std::sin(turn));
    }
  }
  for (Index r = 0; r + 1 < rows; ++r) {
    for (Index c = 0; c < columns; ++c) {
      const Index a = r * (columns + 1) + c, d = a + columns + 1;
      mesh.triangles.push_back({a, d, d + 1});
      mesh.triangles.push_back({a, d + 1, a + 1});
    }
  }
  return mesh;
}

/// A tube, open at both ends, whose radius goes from `low` at its bottom to `high` at its top.
inline TriangleMesh tube(double low, double high, Index facets, Index rings, double from,
                         double to) {
  TriangleMesh mesh;
  for (Index r = 0; r < rings; ++r) {
    const double up = static_cast<double>(r) / (rings - 1), radius = low + (high - low) * up;
    for (Index c = 0; c < facets; ++c) {
      const double turn = 2 * std::numbers::pi * c / facets;
      mesh.positions.emplace_back(radius * std::cos(turn), from + (to - from) * up,
                                  radius * std::sin(turn));
    }
  }
  for (Index r = 0; r + 1 < rings; ++r) {
    for (Index c = 0; c < facets; ++c) {
      const Index a = r * facets + c, b = r * facets + (c + 1) % facets;
      mesh.triangles.push_back({a, a + facets, b + facets});
      mesh.triangles.push_back({a, b + facets, b});
    }
  }
  return mesh;
}

/// A closed cylinder that stands on the plane y = 0.
inline TriangleMesh closed_cylinder(double radius, double height, Index facets, Index rings) {
  TriangleMesh mesh;
  for (Index r = 0; r < rings; ++r) {
    for (Index c = 0; c < facets; ++c) {
      const double turn = 2 * std::numbers::pi * c / facets;
      mesh.positions.emplace_back(radius * std::cos(turn), height * r / (rings - 1),
                                  radius * std::sin(turn));
    }
  }
  const Index bottom = facets * rings, top = bottom + 1, last = bottom - facets;
  mesh.positions.emplace_back(0, 0, 0);
  mesh.positions.emplace_back(0, height, 0);
  for (Index c = 0; c < facets; ++c) {
    const Index next = (c + 1) % facets;
    for (Index first = 0; first < last; first += facets) {
      const Index a = first + c, b = first + next;
      mesh.triangles.push_back({a, a + facets, b + facets});
      mesh.triangles.push_back({a, b + facets, b});
    }
    mesh.triangles.push_back({c, next, bottom});
    mesh.triangles.push_back({last + next, last + c, top});
  }
  return mesh;
}

}  // namespace weft::test
