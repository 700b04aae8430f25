// Looks up triangles in the fabric, and lays them flat beside each other.

#include "core/cloth/corner_places.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace weft {
namespace {

using Place = Eigen::Vector2d;

/// The ends of a side and the corner opposite to it, in the order of its triangle.
template <class Real>
std::array<Place, 3> seen_from(const TriangleSide& side, const ClothModel<Real>& model) {
  const CornerUv corners = corner_places(model, side.triangle);
  std::array<Place, 3> seen;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& corner = corners[(static_cast<std::size_t>(side.corner) + 1 + k) % 3];
    seen[k] = {corner[0], corner[1]};
  }
  return seen;
}

/// Where a triangle's third corner lies beside its edge from the origin along x: the way along that
/// from the first end, and the height [m]. The edge may be sewn to another length.
Place apex(const std::array<Place, 3>& seen, double length) {
  const Place along = seen[1] - seen[0], to = seen[2] - seen[0];
  const double doubled = std::abs(along[0] * to[1] - along[1] * to[0]);
  return {to.dot(along) / along.squaredNorm() * length, doubled / length};
}

double sewn_length(const std::array<Place, 3>& first, const std::array<Place, 3>& second) {
  return ((first[1] - first[0]).norm() + (second[1] - second[0]).norm()) / 2;
}

}  // namespace

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
bool rests_by_triangle(const ClothModel<Real>& model) {
  return !model.parts.empty() && model.parts.front().rests_by_triangle;
}

template <class Real>
double rest_length2(const ClothModel<Real>& model, const TriangleSide& first,
                    const TriangleSide& second) {
  if (rests_by_triangle(model))
    return std::pow(sewn_length(seen_from(first, model), seen_from(second, model)), 2);
  const auto end = [&](std::size_t k) {
    return model.rest_positions[static_cast<std::size_t>(first.ends[k])];
  };
  return (end(1) - end(0)).template cast<double>().squaredNorm();
}

template <class Real>
std::map<Edge, std::array<Vec3d, 4>> unrolled_hinges(const ClothModel<Real>& model,
                                                     const ClothPart<Real>& part) {
  assert(part.rests_by_triangle);
  const auto begin = model.triangles.begin() + part.triangles.first;
  std::vector<TriangleSide> sides = sorted_sides({begin, begin + part.triangles.count});
  for (TriangleSide& side : sides) side.triangle += part.triangles.first;
  std::map<Edge, std::array<Vec3d, 4>> hinges;
  for (std::size_t s = 0; s + 1 < sides.size(); ++s) {
    const TriangleSide &first = sides[s], &second = sides[s + 1];
    if (first.ends != second.ends) continue;
    const auto above = seen_from(first, model), below = seen_from(second, model);
    const double length = sewn_length(above, below);
    const Place up = apex(above, length);
    Place down = apex(below, length);
    // Triangles that face the same side run along their edge in opposite directions.
    const auto start_of = [&](const TriangleSide& side) {
      return model.triangles[static_cast<std::size_t>(side.triangle)]
                            [(static_cast<std::size_t>(side.corner) + 1) % 3];
    };
    if (start_of(first) != start_of(second)) down[0] = length - down[0];
    hinges[first.ends] = {Vec3d::Zero(), Vec3d(length, 0, 0), Vec3d(up[0], up[1], 0),
                          Vec3d(down[0], -down[1], 0)};
  }
  return hinges;
}

#define WEFT_INSTANTIATE(Real)                                                                     \
  template std::array<std::array<Real, 2>, 3> stored_corners(const ClothModel<Real>&, Index);      \
  template CornerUv corner_places(const ClothModel<Real>&, Index);                                 \
  template bool rests_by_triangle(const ClothModel<Real>&);                                        \
  template double rest_length2(const ClothModel<Real>&, const TriangleSide&, const TriangleSide&); \
  template std::map<Edge, std::array<Vec3d, 4>> unrolled_hinges(const ClothModel<Real>&,           \
                                                                const ClothPart<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
