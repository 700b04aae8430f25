// Sides, crossings and turns of a polygon in its plane.

#include "core/geometry/plane_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/math/exact_sign.h"

namespace weft {

Vec3d doubled_area_of(const std::vector<Vec3d>& corners) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return sum;
}

PlanePolygon::PlanePolygon(const std::vector<Vec3d>& corners, const Vec3d& normal) {
  int along = 0;
  normal.cwiseAbs().maxCoeff(&along);
  int x = (along + 1) % 3, y = (along + 2) % 3;
  if (normal[along] < 0) std::swap(x, y);
  for (const Vec3d& corner : corners) points_.push_back({corner[x], corner[y]});
}

int PlanePolygon::turn(std::size_t a, std::size_t b, std::size_t c) const {
  const Point &p = points_[a], &q = points_[b], &r = points_[c];
  const double left = (q[0] - p[0]) * (r[1] - p[1]), right = (q[1] - p[1]) * (r[0] - p[0]);
  const double area = left - right;
  // Twice the bound of the rounding (Shewchuk 1997).
  const double bound = 4 * std::numeric_limits<double>::epsilon();
  if (std::abs(area) > bound * (std::abs(left) + std::abs(right))) return area > 0 ? 1 : -1;
  if (left == 0 && right == 0) return 0;
  return orientation({p[0], p[1], 0}, {q[0], q[1], 0}, {r[0], r[1], 0}, {p[0], p[1], -1});
}

bool PlanePolygon::is_near(std::size_t corner, std::size_t a, std::size_t b, double angle) const {
  const Point &p = points_[corner], &q = points_[a], &r = points_[b];
  const double dx = r[0] - q[0], dy = r[1] - q[1], length = std::hypot(dx, dy);
  const double along = (p[0] - q[0]) * dx + (p[1] - q[1]) * dy;
  if (!(along > 0 && along < length * length)) return false;
  const double height = std::abs((p[1] - q[1]) * dx - (p[0] - q[0]) * dy) / length;
  const double nearer = std::min(std::hypot(p[0] - q[0], p[1] - q[1]),  //
                                 std::hypot(p[0] - r[0], p[1] - r[1]));
  return height <= angle * nearer;
}

bool PlanePolygon::is_between(std::size_t corner, std::size_t a, std::size_t b) const {
  const Point &p = points_[corner], &q = points_[a], &r = points_[b];
  if (p == q || p == r) return false;
  for (std::size_t k = 0; k < 2; ++k) {
    if (p[k] < std::min(q[k], r[k]) || p[k] > std::max(q[k], r[k])) return false;
  }
  return turn(a, b, corner) == 0;
}

PlanePolygon::Place PlanePolygon::place_in(const std::array<std::size_t, 3>& triangle,
                                           std::size_t corner, double flat) const {
  const auto [a, b, c] = triangle;
  const Point& p = points_[corner];
  for (std::size_t k = 0; k < 2; ++k) {
    const double u = points_[a][k], v = points_[b][k], w = points_[c][k];
    const double slack =
        flat * std::abs(w - u) + flat * std::abs(points_[c][1 - k] - points_[a][1 - k]);
    if (p[k] < std::min({u, v, w}) - slack || p[k] > std::max({u, v, w}) + slack)
      return Place::outside;
  }
  if (flat > 0 && is_near(corner, a, c, flat)) return Place::inside;
  const int first = turn(a, b, corner), second = turn(b, c, corner), third = turn(c, a, corner);
  if (first < 0 || second < 0 || third < 0) return Place::outside;
  if (first > 0 && second > 0) return Place::inside;
  return Place::touching;
}

bool PlanePolygon::enters(const std::array<std::size_t, 3>& triangle, std::size_t corner,
                          std::size_t to) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = triangle[k], b = triangle[(k + 1) % 3];
    if (turn(a, b, corner) == 0 && turn(a, b, to) <= 0) return false;
  }
  return true;
}

bool PlanePolygon::sides_cross(std::size_t i, std::size_t j) const {
  const std::size_t a = i, b = after(i), c = j, d = after(j);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto [low, high] = std::minmax(points_[a][k], points_[b][k]);
    if (std::max(points_[c][k], points_[d][k]) < low ||
        std::min(points_[c][k], points_[d][k]) > high)
      return false;
  }
  if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return true;
  return passes_through(c, i) || passes_through(a, j);
}

/// Whether the way over a corner goes from one side of a polygon's side to the other.
bool PlanePolygon::passes_through(std::size_t corner, std::size_t side) const {
  const std::size_t a = side, b = after(side);
  return is_between(corner, a, b) && turn(a, b, before(corner)) * turn(a, b, after(corner)) < 0;
}

bool PlanePolygon::goes_round_once() const {
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point &p = points_[before(i)], &q = points_[i], &r = points_[after(i)];
    const double ux = q[0] - p[0], uy = q[1] - p[1], vx = r[0] - q[0], vy = r[1] - q[1];
    sum += std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  }
  return std::abs(sum - 2 * std::numbers::pi) < 1;
}

bool PlanePolygon::crosses_itself() const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t j = i + 1; j < points_.size(); ++j) {
      if (sides_cross(i, j)) return true;
    }
  }
  return !goes_round_once();
}

}  // namespace weft
