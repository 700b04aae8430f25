// Fits slopes across the edges of a flat mesh that are exact for quadratic fields.

#include "core/cloth/edge_slope.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/cloth/constants.h"
#include "core/geometry/triangle_sides.h"

namespace weft {
namespace {

std::vector<Edge> ends_of(const std::vector<EdgeSides>& edges) {
  std::vector<Edge> ends;
  for (const EdgeSides& edge : edges) ends.push_back(edge.ends);
  return ends;
}

/// The edges of each triangle, opposite to its corners.
std::vector<std::array<Index, 3>> edges_of_triangles(const std::vector<EdgeSides>& edges,
                                                     const std::vector<Triangle>& triangles) {
  std::vector<std::array<Index, 3>> of(triangles.size(), {kNone, kNone, kNone});
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (edges[e].triangle[side] == kNone) continue;
      const auto t = static_cast<std::size_t>(edges[e].triangle[side]);
      const auto corner =
          std::find(triangles[t].begin(), triangles[t].end(), edges[e].opposite[side]);
      of[t][static_cast<std::size_t>(corner - triangles[t].begin())] = static_cast<Index>(e);
    }
  }
  return of;
}

void add_member(Index particle, std::vector<Index>& members) {
  if (std::find(members.begin(), members.end(), particle) == members.end())
    members.push_back(particle);
}

}  // namespace

std::vector<EdgeSides> sides_of(const std::vector<Triangle>& triangles) {
  std::vector<EdgeSides> edges;
  for (const TriangleSide& side : sorted_sides(triangles)) {
    if (edges.empty() || edges.back().ends != side.ends)
      edges.push_back({side.ends, {kNone, kNone}, {kNone, kNone}});
    EdgeSides& edge = edges.back();
    const std::size_t second = edge.triangle[0] == kNone ? 0 : 1;
    assert(edge.triangle[second] == kNone && "at most two triangles at an edge");
    edge.triangle[second] = side.triangle;
    edge.opposite[second] =
        triangles[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.corner)];
  }
  return edges;
}

void add_weight(Index particle, double weight, std::vector<ParticleWeight>& list) {
  for (ParticleWeight& one : list) {
    if (one.particle != particle) continue;
    one.weight += weight;
    return;
  }
  list.push_back({particle, weight});
}

EdgeSlopes::EdgeSlopes(const Vec3Array<double>& x, const std::vector<Triangle>& triangles)
    : x_(x), triangles_(triangles), edges_(sides_of(triangles)),
      of_(edges_of_triangles(edges_, triangles)), neighbours_(x.size(), ends_of(edges_)) {}

/// Coordinates in the plane of an edge, from its middle.
struct EdgeSlopes::Frame {
  Vec3d middle, along, across;
  double length = 0;                  ///< of the edge [m]
  double height = 0;                  ///< mean of its triangles' [m]
  std::array<double, 2> foot{}, y{};  ///< along and across, of the triangles' third corners [m]

  /// In units of the edge's length and height [1].
  Eigen::Vector2d place(const Vec3d& p) const {
    return {(p - middle).dot(along) / length, (p - middle).dot(across) / height};
  }
};

EdgeSlopes::Frame EdgeSlopes::frame_of(const EdgeSides& edge) const {
  const auto at = [&](Index i) -> const Vec3d& { return x_[static_cast<std::size_t>(i)]; };
  Frame frame;
  frame.middle = 0.5 * (at(edge.ends[0]) + at(edge.ends[1]));
  frame.along = at(edge.ends[1]) - at(edge.ends[0]);
  frame.length = frame.along.norm();
  assert(frame.length > 0);
  frame.along /= frame.length;
  const Vec3d up = at(edge.opposite[0]) - frame.middle;
  frame.across = (up - frame.along * up.dot(frame.along)).normalized();
  for (std::size_t side = 0; side < (edge.is_border() ? 1U : 2U); ++side) {
    const Vec3d to = at(edge.opposite[side]) - frame.middle;
    frame.foot[side] = to.dot(frame.along);
    frame.y[side] = to.dot(frame.across);
  }
  frame.height = edge.is_border() ? frame.y[0] : 0.5 * (frame.y[0] - frame.y[1]);
  assert(frame.height > 0);
  return frame;
}

/// Corners of the edge's triangles and of those beside them.
EdgeSlopes::Members EdgeSlopes::nearest(const EdgeSides& edge) const {
  Members members(edge.ends.begin(), edge.ends.end());
  for (const Index t : edge.triangle) {
    if (t == kNone) continue;
    for (const Index e : of_[static_cast<std::size_t>(t)]) {
      for (const Index opposite : edges_[static_cast<std::size_t>(e)].opposite) {
        if (opposite != kNone) add_member(opposite, members);
      }
    }
  }
  return members;
}

/// Those and all that an edge joins to them.
EdgeSlopes::Members EdgeSlopes::grown(const Members& members) const {
  Members more = members;
  for (const Index i : members) {
    for (const auto& neighbour : neighbours_.of(static_cast<std::size_t>(i)))
      add_member(neighbour.particle, more);
  }
  return more;
}

namespace {

/// A fit of quadratic fields to some particles. The nearer ones count more.
class QuadraticFit {
 public:
  /// @param places  of the particles, in units such that nearby ones are about 1 away
  explicit QuadraticFit(const std::vector<Eigen::Vector2d>& places) : places_(places) {
    Eigen::Matrix3d linear = Eigen::Matrix3d::Zero(), mixed = linear, square = linear;
    for (const Eigen::Vector2d& p : places_) {
      const Eigen::Vector3d a = linear_part(p), q = square_part(p);
      linear += nearness(p) * a * a.transpose();
      mixed += nearness(p) * a * q.transpose();
      square += nearness(p) * q * q.transpose();
    }
    linear_of_square_ = linear.ldlt().solve(mixed);
    solver_.computeDirect(square - mixed.transpose() * linear_of_square_);
  }

  /// Whether the particles tell all quadratic fields apart.
  bool is_determined() const { return solver_.eigenvalues()[0] > kTellsApart; }

  /// The least weights that vanish for linear fields and give these values for x^2/2, xy, y^2/2, as
  /// far as determined.
  std::vector<double> weights(const Eigen::Vector3d& values) const {
    Eigen::Vector3d of_modes = solver_.eigenvectors().transpose() * values;
    for (int k = 0; k < 3; ++k) {
      const double own = solver_.eigenvalues()[k];
      of_modes[k] = own > kTellsApart ? of_modes[k] / own : 0;
    }
    const Eigen::Vector3d factors = solver_.eigenvectors() * of_modes;
    std::vector<double> weights;
    for (const Eigen::Vector2d& p : places_)
      weights.push_back(
          nearness(p) *
          (square_part(p) - linear_of_square_.transpose() * linear_part(p)).dot(factors));
    return weights;
  }

  static Eigen::Vector3d square_part(const Eigen::Vector2d& p) {
    return {p[0] * p[0] / 2, p[0] * p[1], p[1] * p[1] / 2};
  }

 private:
  static Eigen::Vector3d linear_part(const Eigen::Vector2d& p) { return {1, p[0], p[1]}; }
  static double nearness(const Eigen::Vector2d& p) {
    const double root = 1 + p.squaredNorm();
    return 1 / (root * root);
  }

  const std::vector<Eigen::Vector2d>& places_;
  Eigen::Matrix3d linear_of_square_;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver_;
};

}  // namespace

std::vector<ParticleWeight> EdgeSlopes::across(const EdgeSides& edge) const {
  const Frame frame = frame_of(edge);
  std::vector<ParticleWeight> slope;
  const double whole = frame.y[0] - frame.y[1];  // of a border edge y[1] is 0
  for (std::size_t side = 0; side < (edge.is_border() ? 1U : 2U); ++side) {
    const double share = edge.is_border() ? 1 : std::abs(frame.y[1 - side]) / whole;
    const double weight = share / frame.y[side], foot = frame.foot[side] / frame.length;
    add_weight(edge.opposite[side], weight, slope);
    add_weight(edge.ends[0], -weight * (0.5 - foot), slope);
    add_weight(edge.ends[1], -weight * (0.5 + foot), slope);
  }
  Eigen::Vector3d wrong = Eigen::Vector3d::Zero();
  for (const ParticleWeight& one : slope)
    wrong += one.weight *
             QuadraticFit::square_part(frame.place(x_[static_cast<std::size_t>(one.particle)]));
  if (!(wrong.cwiseAbs().maxCoeff() * frame.height > kRightSlope)) return slope;
  Members members = nearest(edge);
  std::vector<Eigen::Vector2d> places;
  for (int round = 0;; ++round) {
    places.clear();
    for (const Index i : members) places.push_back(frame.place(x_[static_cast<std::size_t>(i)]));
    const QuadraticFit fit(places);
    if (!fit.is_determined() && round < kSlopeRounds) {
      members = grown(members);
      continue;
    }
    const std::vector<double> more = fit.weights(-wrong);
    for (std::size_t k = 0; k < more.size(); ++k) add_weight(members[k], more[k], slope);
    return slope;
  }
}

}  // namespace weft
