// Sorts the sides of triangles so that neighbours meet.

#include "core/geometry/triangle_sides.h"

#include <algorithm>
#include <tuple>

namespace weft {

std::vector<TriangleSide> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<TriangleSide> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][(k + 1) % 3], triangles[t][(k + 2) % 3]);
      sides.push_back({{low, high}, static_cast<Index>(t), static_cast<Index>(k)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const TriangleSide& a, const TriangleSide& b) {
    return std::tie(a.ends, a.triangle, a.corner) < std::tie(b.ends, b.triangle, b.corner);
  });
  return sides;
}

}  // namespace weft
