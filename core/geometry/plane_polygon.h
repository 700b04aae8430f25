#pragma once

#include <array>
#include <vector>

#include "core/types.h"

// A polygon seen along its normal, with exact answers on which side of a line a corner lies.

namespace weft {

/// The normal of a polygon, as long as twice its area (Newell).
Vec3d doubled_area_of(const std::vector<Vec3d>& corners);

/// The polygon without the coordinate along which its normal is longest: corners in a line stay so,
/// bit for bit. It runs counter-clockwise.
class PlanePolygon {
 public:
  /// Where a corner lies to a triangle of others. On the open side from the third to the first it
  /// counts as inside.
  enum class Place { outside, touching, inside };

  PlanePolygon(const std::vector<Vec3d>& corners, const Vec3d& normal);

  /// +1 if the way over a, b and c turns left there, -1 right, 0 if they lie in a line.
  int turn(std::size_t a, std::size_t b, std::size_t c) const;

  /// Whether a corner lies on the line from a to b, except for an angle at a and b.
  bool is_near(std::size_t corner, std::size_t a, std::size_t b, double angle) const;

  /// @param flat  corners that see the ends of the third side at angles up to it lie on that side
  Place place_in(const std::array<std::size_t, 3>& triangle, std::size_t corner, double flat) const;

  /// Whether the way from a corner that touches the triangle to another begins inside.
  bool enters(const std::array<std::size_t, 3>& triangle, std::size_t corner, std::size_t to) const;

  /// Whether sides cross, or the polygon goes round more than once.
  bool crosses_itself() const;

 private:
  using Point = std::array<double, 2>;

  bool is_between(std::size_t corner, std::size_t a, std::size_t b) const;
  bool sides_cross(std::size_t i, std::size_t j) const;
  bool passes_through(std::size_t corner, std::size_t side) const;
  bool goes_round_once() const;
  std::size_t after(std::size_t i) const { return i + 1 == points_.size() ? 0 : i + 1; }
  std::size_t before(std::size_t i) const { return (i == 0 ? points_.size() : i) - 1; }

  std::vector<Point> points_;
};

}  // namespace weft
