// Looks up triangles and edges in the fabric, and unrolls hinges.

#include "core/cloth/corner_places.h"

#include <cassert>
#include <cmath>

#include "core/cloth/unfolding.h"

namespace weft {
template <class Real>
std::array<std::array<Real, 2>, 3> stored_corners(const ClothModel<Real>& model, Index triangle) {
  const auto t = static_cast<std::size_t>(triangle);
  assert(t < model.triangles.size());
  if (!model.corner_material.empty()) return model.corner_material[t];
  std::array<std::array<Real, 2>, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = model.material[static_cast<std::size_t>(model.triangles[t][k])];
  return corners;
}

template <class Real>
CornerUv corner_places(const ClothModel<Real>& model, Index triangle) {
  const std::array<std::array<Real, 2>, 3> stored = stored_corners(model, triangle);
  CornerUv corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = {static_cast<double>(stored[k][0]), static_cast<double>(stored[k][1])};
  return corners;
}

template <class Real>
std::array<std::array<Real, 2>, 2> stored_ends(const ClothModel<Real>& model,
                                               const TriangleSide& side) {
  const auto corners = stored_corners(model, side.triangle);
  return {corners[static_cast<std::size_t>(side.corner + 1) % 3],
          corners[static_cast<std::size_t>(side.corner + 2) % 3]};
}

template <class Real>
bool rests_by_triangle(const ClothModel<Real>& model) {
  return !model.parts.empty() && model.parts.front().rests_by_triangle;
}

template <class Real>
double rest_length2(const ClothModel<Real>& model, const TriangleSide& first,
                    const TriangleSide& second) {
  const auto length_in = [&](const TriangleSide& side) {
    const auto [a, b] = stored_ends(model, side);
    return std::hypot(static_cast<double>(b[0]) - static_cast<double>(a[0]),
                      static_cast<double>(b[1]) - static_cast<double>(a[1]));
  };
  if (rests_by_triangle(model)) return std::pow((length_in(first) + length_in(second)) / 2, 2);
  const auto end = [&](std::size_t k) {
    return model.rest_positions[static_cast<std::size_t>(first.ends[k])];
  };
  return (end(1) - end(0)).template cast<double>().squaredNorm();
}

template <class Real>
std::map<Edge, std::array<Vec3d, 4>> unrolled_hinges(const ClothModel<Real>& model,
                                                     const ClothPart<Real>& part) {
  assert(part.rests_by_triangle);
  FlatShapes shapes;
  for (Index t = part.triangles.first; t < part.triangles.end(); ++t) {
    shapes.triangles.push_back(model.triangles[static_cast<std::size_t>(t)]);
    const CornerUv uv = corner_places(model, t);
    auto& corners = shapes.corners.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = {uv[k][0], uv[k][1]};
  }
  std::map<Edge, std::array<Vec3d, 4>> hinges;
  for (const EdgeSides& edge : sides_of(shapes.triangles)) {
    if (edge.is_border()) continue;
    const double length = length_of(shapes, edge);
    const BesideEdge above = beside(shapes, edge, 0), below = beside(shapes, edge, 1);
    const double up = length / above.length, down = length / below.length;
    hinges[edge.ends] = {Vec3d::Zero(), Vec3d(length, 0, 0),
                         Vec3d(above.foot * up, above.height / up, 0),
                         Vec3d(below.foot * down, -below.height / down, 0)};
  }
  return hinges;
}

#define WEFT_INSTANTIATE(Real)                                                                     \
  template std::array<std::array<Real, 2>, 3> stored_corners(const ClothModel<Real>&, Index);      \
  template std::array<std::array<Real, 2>, 2> stored_ends(const ClothModel<Real>&,                 \
                                                          const TriangleSide&);                    \
  template CornerUv corner_places(const ClothModel<Real>&, Index);                                 \
  template bool rests_by_triangle(const ClothModel<Real>&);                                        \
  template double rest_length2(const ClothModel<Real>&, const TriangleSide&, const TriangleSide&); \
  template std::map<Edge, std::array<Vec3d, 4>> unrolled_hinges(const ClothModel<Real>&,           \
                                                                const ClothPart<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
