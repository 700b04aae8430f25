// Unfolds triangles one after the other.

#include "core/cloth/unfolding.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/cloth/constants.h"

namespace weft {

Unfolding::Unfolding(const EdgeSides& edge, const Vec3Array<double>& x,
                     const std::vector<EdgeSides>& edges,
                     const std::vector<std::array<Index, 3>>& of)
    : x_(x), edges_(edges), of_(of) {
  const auto at = [&](Index i) -> const Vec3d& { return x_[static_cast<std::size_t>(i)]; };
  const double half = 0.5 * (at(edge.ends[1]) - at(edge.ends[0])).norm();
  assert(half > 0);
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
  const auto at = [&](Index i) -> const Vec3d& { return x_[static_cast<std::size_t>(i)]; };
  const Vec3d along = (at(from.ends[1]) - at(from.ends[0])).normalized();
  const Vec3d to = at(apex) - at(from.ends[0]);
  const double foot = to.dot(along), height = (to - along * foot).norm();
  const Eigen::Vector2d start = *place(from.ends[0]);
  const Eigen::Vector2d line = (*place(from.ends[1]) - start).normalized();
  Eigen::Vector2d out(-line[1], line[0]);
  const Index other = from.opposite[1 - side];
  const Eigen::Vector2d* const before = other == kNone ? nullptr : place(other);
  if (before != nullptr && out.dot(*before - start) > 0) out = -out;
  places_.push_back({apex, start + line * foot + out * height});
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
