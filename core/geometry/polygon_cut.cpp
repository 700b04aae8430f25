// Cuts off the ears of polygons, the best-shaped first.

#include "core/geometry/polygon_cut.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <queue>

#include "core/geometry/constants.h"
#include "core/geometry/plane_polygon.h"

namespace weft {
namespace {

/// The smallest angle lies between the two longer sides.
double sine_of_smallest_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  std::array<double, 3> sides = {(b - a).norm(), (c - b).norm(), (a - c).norm()};
  std::sort(sides.begin(), sides.end());
  return sides[1] > 0 ? (b - a).cross(c - a).norm() / (sides[1] * sides[2]) : 0;
}

/// Cuts a polygon whose sides do not cross. What is left after each ear is again such a polygon,
/// which has an ear with an area, so that it never ends before all is cut.
class EarCutter {
 public:
  EarCutter(const std::vector<Vec3d>& places, const PlanePolygon& plane)
      : places_(places), plane_(plane), left_(places.size()), ears_(left_), waiting_(left_) {
    for (std::size_t i = 0; i < left_; ++i) ring_.push_back({(i + left_ - 1) % left_, next(i)});
  }

  /// @returns the triangles; fewer than two less than corners: the rest cannot be cut
  std::vector<Triangle> cut() {
    // Corners in a row are told from rounding first, so that no sliver is cut along the row.
    for (const double flat : {kFlatCorner, 0.0}) {
      flat_ = flat;
      for (std::size_t before = left_ + 1; left_ > 3 && left_ < before;) {
        before = left_;
        consider_all();
        cut_considered();
      }
    }
    if (left_ == 3 && turn(first_) > 0) emit(first_);
    return std::move(triangles_);
  }

 private:
  struct Neighbours {
    std::size_t previous, next;
  };
  /// The triangle of a corner and its neighbours.
  struct Ear {
    std::size_t seen = 0;     ///< corners below this do not block it
    std::size_t version = 0;  ///< of its triangle
  };
  /// In the order of cutting.
  struct Turn {
    double shape;
    std::size_t corner, version;
    bool operator<(const Turn& other) const {
      return shape != other.shape ? shape < other.shape : corner > other.corner;
    }
  };

  std::size_t next(std::size_t i) const { return (i + 1) % places_.size(); }
  int turn(std::size_t b) const { return plane_.turn(ring_[b].previous, b, ring_[b].next); }
  bool is_cut(std::size_t i) const { return ring_[i].next == i; }

  void consider(std::size_t b) {
    const auto [a, c] = ring_[b];
    ears_[b] = {0, ears_[b].version + 1};
    const double shape = sine_of_smallest_angle(places_[a], places_[b], places_[c]);
    if (turn(b) > 0 && shape > flat_) queue_.push({shape, b, ears_[b].version});
  }

  void consider_all() {
    queue_ = {};
    for (auto& each : waiting_) each.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!is_cut(i)) consider(i);
    }
  }

  void cut_considered() {
    while (left_ > 3 && !queue_.empty()) {
      const Turn best = queue_.top();
      queue_.pop();
      if (is_cut(best.corner) || best.version != ears_[best.corner].version) continue;
      const std::size_t blocker = blocker_of(best.corner);
      if (blocker == places_.size())
        cut_off(best.corner);
      else
        waiting_[blocker].push_back(best);
    }
  }

  void emit(std::size_t b) {
    triangles_.push_back({static_cast<Index>(ring_[b].previous), static_cast<Index>(b),
                          static_cast<Index>(ring_[b].next)});
  }

  void cut_off(std::size_t b) {
    emit(b);
    const auto [a, c] = ring_[b];
    ring_[a].next = c;
    ring_[c].previous = a;
    ring_[b] = {b, b};
    first_ = a;
    --left_;
    consider(a);
    consider(c);
    for (const Turn& each : waiting_[b]) queue_.push(each);
    waiting_[b].clear();
  }

  /// A corner in the way of cutting off b, or the number of corners. Corners are only removed, so
  /// the search goes on where it ended; those that touch may later be in the way.
  std::size_t blocker_of(std::size_t b) {
    const auto [a, c] = ring_[b];
    std::size_t& seen = ears_[b].seen;
    bool touched = false;
    std::size_t j = seen;
    for (; j < places_.size(); ++j) {
      if (is_cut(j) || j == a || j == b || j == c) continue;
      const PlanePolygon::Place place = plane_.place_in({a, b, c}, j, flat_);
      if (place == PlanePolygon::Place::outside) continue;
      if (place == PlanePolygon::Place::inside) break;
      if (plane_.enters({a, b, c}, j, ring_[j].previous) ||
          plane_.enters({a, b, c}, j, ring_[j].next))
        break;
      touched = true;
    }
    seen = touched ? 0 : j;
    return j;
  }

  const std::vector<Vec3d>& places_;
  const PlanePolygon& plane_;
  std::size_t left_, first_ = 0;
  double flat_ = 0;
  std::vector<Neighbours> ring_;
  std::vector<Ear> ears_;
  std::vector<std::vector<Turn>> waiting_;  // by what blocks them
  std::priority_queue<Turn> queue_;
  std::vector<Triangle> triangles_;
};

/// Numbers of the corners without those in the place of the one before.
std::vector<Index> distinct_corners(std::span<const Vec3d> corners) {
  std::vector<Index> distinct;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t before = (i == 0 ? corners.size() : i) - 1;
    if (corners[i] != corners[before]) distinct.push_back(static_cast<Index>(i));
  }
  return distinct;
}

/// The first corner of four that is not convex, or 0.
std::size_t concave_of_four(const PlanePolygon& plane) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t before = (i + 3) % 4, after = (i + 1) % 4;
    if (plane.turn(before, i, after) <= 0 || plane.is_near(i, before, after, kFlatCorner)) return i;
  }
  return 0;
}

std::vector<Triangle> fan(std::size_t corners, std::size_t first) {
  std::vector<Triangle> triangles;
  const auto corner = [&](std::size_t k) { return static_cast<Index>((first + k) % corners); };
  for (std::size_t k = 1; k + 1 < corners; ++k)
    triangles.push_back({corner(0), corner(k), corner(k + 1)});
  return triangles;
}

double circumference(const std::vector<Vec3d>& places) {
  double round = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    round += (places[(i + 1) % places.size()] - places[i]).norm();
  return round;
}

/// Whether no corner spans more than an area with the line from the first to the one farthest away.
bool lie_in_a_row(const std::vector<Vec3d>& places, double area) {
  Vec3d along = Vec3d::Zero();
  for (const Vec3d& p : places) {
    if ((p - places[0]).norm() > along.norm()) along = p - places[0];
  }
  return std::all_of(places.begin(), places.end(),
                     [&](const Vec3d& p) { return (p - places[0]).cross(along).norm() <= area; });
}

PolygonCut cut_distinct(const std::vector<Vec3d>& places) {
  constexpr const char* kCrossing = "polygons whose sides do not cross";
  const double round = circumference(places), least = kLeastPolygonArea * round * round;
  const Vec3d normal = doubled_area_of(places);
  if (!(normal.norm() > least)) {
    if (lie_in_a_row(places, least)) return {fan(places.size(), 0), false};
    return {{}, true, kCrossing};
  }
  const PlanePolygon plane(places, normal);
  if (plane.crosses_itself()) return {{}, true, kCrossing};
  if (places.size() == 3) return {fan(3, 0)};
  if (places.size() == 4) return {fan(4, concave_of_four(plane))};
  PolygonCut result = {EarCutter(places, plane).cut()};
  if (result.triangles.size() + 2 != places.size())
    return {{}, true, "polygons whose sides do not cross or lie in each other's way"};
  return result;
}

}  // namespace

PolygonCut cut_polygon(std::span<const Vec3d> corners) {
  assert(corners.size() >= 3);
  if (corners.size() > kMostPolygonCorners)
    return {{}, true, "polygons of at most " + std::to_string(kMostPolygonCorners) + " corners"};
  const std::vector<Index> distinct = distinct_corners(corners);
  std::vector<Vec3d> places;
  for (const Index i : distinct) places.push_back(corners[static_cast<std::size_t>(i)]);
  PolygonCut result = cut_distinct(places);
  for (Triangle& t : result.triangles) {
    for (Index& i : t) i = distinct[static_cast<std::size_t>(i)];
  }
  return result;
}

}  // namespace weft
