// Unfolds triangles one after the other.

#include "core/cloth/unfolding.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/cloth/constants.h"

namespace weft {

BesideEdge beside(const FlatShapes& shapes, const EdgeSides& edge, std::size_t side) {
  assert(side < 2 && edge.triangle[side] != kNone);
  const auto t = static_cast<std::size_t>(edge.triangle[side]);
  const auto corner = [&](Index particle) -> const Eigen::Vector2d& {
    const Triangle& particles = shapes.triangles[t];
    const auto found = std::find(particles.begin(), particles.end(), particle);
    assert(found != particles.end());
    return shapes.corners[t][static_cast<std::size_t>(found - particles.begin())];
  };
  const Eigen::Vector2d start = corner(edge.ends[0]), along = corner(edge.ends[1]) - start,
                        to = corner(edge.opposite[side]) - start;
  const double length = along.norm();
  assert(length > 0);
  return {length, to.dot(along) / length, std::abs(along[0] * to[1] - along[1] * to[0]) / length};
}

double length_of(const FlatShapes& shapes, const EdgeSides& edge) {
  const double length = beside(shapes, edge, 0).length;
  return edge.is_border() ? length : 0.5 * (length + beside(shapes, edge, 1).length);
}

Unfolding::Unfolding(const EdgeSides& edge, const FlatShapes& shapes,
                     const std::vector<EdgeSides>& edges,
                     const std::vector<std::array<Index, 3>>& of)
    : shapes_(shapes), edges_(edges), of_(of) {
  const double half = 0.5 * length_of(shapes, edge);
  places_.push_back({edge.ends[0], {-half, 0}});
  places_.push_back({edge.ends[1], {half, 0}});
  for (std::size_t side = 0; side < (edge.is_border() ? 1U : 2U); ++side)
    add_triangle(edge.triangle[side], edge, side);
}

const Eigen::Vector2d* Unfolding::place(Index particle) const {
  const auto found = std::find_if(places_.begin(), places_.end(),
                                  [&](const Place& place) { return place.particle == particle; });
  return found == places_.end() ? nullptr : &found->at;
}

/// Lays a triangle beyond an edge that has its place: away from the triangle on its other side, or
/// above the first axis if that is none or lies below.
void Unfolding::add_triangle(Index triangle, const EdgeSides& from, std::size_t side) {
  triangles_.push_back(triangle);
  for (const Index e : of_[static_cast<std::size_t>(triangle)]) {
    const EdgeSides& edge = edges_[static_cast<std::size_t>(e)];
    if (edge.ends == from.ends || edge.is_border()) continue;
    borders_.push_back({e, edge.triangle[0] == triangle ? 1U : 0U});
  }
  const Index apex = from.opposite[side];
  if (place(apex) != nullptr) return;
  const BesideEdge own = beside(shapes_, from, side);
  const Eigen::Vector2d start = *place(from.ends[0]), line = *place(from.ends[1]) - start;
  Eigen::Vector2d out = Eigen::Vector2d(-line[1], line[0]).normalized();
  const Index other = from.opposite[1 - side];
  const Eigen::Vector2d* const before = other == kNone ? nullptr : place(other);
  if (before != nullptr && out.dot(*before - start) > 0) out = -out;
  places_.push_back({apex, start + line * (own.foot / own.length) + out * own.height});
}

void Unfolding::cross(const Border& border) {
  const EdgeSides& edge = edges_[static_cast<std::size_t>(border.edge)];
  const Index triangle = edge.triangle[border.beyond];
  if (std::find(triangles_.begin(), triangles_.end(), triangle) == triangles_.end())
    add_triangle(triangle, edge, border.beyond);
}

void Unfolding::lay_out(std::vector<Index>& particles) {
  const auto is_unplaced = [&](Index i) { return place(i) == nullptr; };
  std::size_t done = 0;
  while (triangles_.size() < kMostUnfolded && crossed_ < borders_.size()) {
    while (done < particles.size() && !is_unplaced(particles[done])) ++done;
    if (done == particles.size()) return;
    const Border border = borders_[crossed_++];
    cross(border);
  }
  particles.erase(std::remove_if(particles.begin(), particles.end(), is_unplaced), particles.end());
}

}  // namespace weft
