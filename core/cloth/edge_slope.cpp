// Fits slopes across the edges of a mesh that are exact for quadratic fields.

#include "core/cloth/edge_slope.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/cloth/constants.h"

namespace weft {
namespace {

std::vector<Edge> ends_of(const std::vector<EdgeSides>& edges) {
  std::vector<Edge> ends;
  for (const EdgeSides& edge : edges) ends.push_back(edge.ends);
  return ends;
}

void add_member(Index particle, std::vector<Index>& members) {
  if (std::find(members.begin(), members.end(), particle) == members.end())
    members.push_back(particle);
}

}  // namespace

void add_weight(Index particle, double weight, std::vector<ParticleWeight>& list) {
  for (ParticleWeight& one : list) {
    if (one.particle != particle) continue;
    one.weight += weight;
    return;
  }
  list.push_back({particle, weight});
}

EdgeSlopes::EdgeSlopes(const Vec3Array<double>& x, const std::vector<Triangle>& triangles,
                       const FlatShapes* shapes)
    : x_(x), edges_(sides_of(triangles)), of_(edges_of_triangles(edges_, triangles)),
      neighbours_(x.size(), ends_of(edges_)), shapes_(shapes) {}

/// Coordinates in the plane of an edge, from its middle.
struct EdgeSlopes::Frame {
  Vec3d middle, along, across;
  double length = 0;                  ///< of the edge [m]
  double height = 0;                  ///< mean of its triangles' [m]
  std::array<double, 2> foot{}, y{};  ///< along and across, of the triangles' third corners [m]
  std::optional<Unfolding> around;    ///< of a mesh that is not flat as a whole

  /// In units of the edge's length and height [1].
  Eigen::Vector2d place(const Vec3d& p) const {
    return {(p - middle).dot(along) / length, (p - middle).dot(across) / height};
  }
};

EdgeSlopes::Frame EdgeSlopes::frame_of(const EdgeSides& edge) const {
  if (shapes_ != nullptr) return unfolded_frame(edge);
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

/// The same of an edge whose surroundings are unfolded, without places in space.
EdgeSlopes::Frame EdgeSlopes::unfolded_frame(const EdgeSides& edge) const {
  Frame frame;
  frame.length = length_of(*shapes_, edge);
  for (std::size_t side = 0; side < (edge.is_border() ? 1U : 2U); ++side) {
    const BesideEdge own = beside(*shapes_, edge, side);
    frame.foot[side] = (own.foot / own.length - 0.5) * frame.length;
    frame.y[side] = side == 0 ? own.height : -own.height;
  }
  frame.height = edge.is_border() ? frame.y[0] : 0.5 * (frame.y[0] - frame.y[1]);
  assert(frame.height > 0);
  frame.around.emplace(edge, *shapes_, edges_, of_);
  return frame;
}

/// Of a particle, in the edge's plane and in units of its length and height [1].
Eigen::Vector2d EdgeSlopes::place_of(Index particle, const Frame& frame) const {
  if (shapes_ == nullptr) return frame.place(x_[static_cast<std::size_t>(particle)]);
  const Eigen::Vector2d* const place = frame.around->place(particle);
  assert(place != nullptr && "only particles that were laid out have a place");
  return {(*place)[0] / frame.length, (*place)[1] / frame.height};
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

/// Those and all that an edge joins to them. The neighbours of a hub lie far from each other, and
/// would make the time of a fan grow with the square of its triangles.
EdgeSlopes::Members EdgeSlopes::grown(const Members& members) const {
  Members more = members;
  for (const Index i : members) {
    if (neighbours_.of(static_cast<std::size_t>(i)).size() > kMostSpokes) continue;
    for (const auto& neighbour : neighbours_.of(static_cast<std::size_t>(i)))
      add_member(neighbour.particle, more);
  }
  return more;
}

namespace {

Eigen::Vector3d squares_at(const Eigen::Vector2d& p) {
  return {p[0] * p[0] / 2, p[0] * p[1], p[1] * p[1] / 2};
}

/// A fit of Fields fields, besides the linear ones, to some particles. The nearer ones count more.
template <int Fields>
class FieldFit {
 public:
  using Values = Eigen::Matrix<double, Fields, 1>;

  /// @param places  of the particles, in units such that nearby ones are about 1 away
  /// @param values  of the fields there, about 1 too
  FieldFit(const std::vector<Eigen::Vector2d>& places, const std::vector<Values>& values)
      : places_(places), values_(values) {
    assert(places.size() == values.size());
    Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
    Mixed mixed = Mixed::Zero();
    Square square = Square::Zero();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double near = nearness(places_[k]);
      const Eigen::Vector3d a = linear_part(places_[k]);
      linear += near * a * a.transpose();
      mixed += near * a * values_[k].transpose();
      square += near * values_[k] * values_[k].transpose();
    }
    linear_of_fields_ = linear.ldlt().solve(mixed);
    const Square own = square - mixed.transpose() * linear_of_fields_;
    if constexpr (Fields == 1)
      solver_.compute(own);
    else
      solver_.computeDirect(own);
  }

  /// Whether the particles tell all the fields apart.
  bool is_determined() const { return solver_.eigenvalues()[0] > kTellsApart; }

  /// The least weights that vanish for linear fields and give these values for the others, as far
  /// as determined.
  std::vector<double> weights(const Values& wanted) const {
    Values of_modes = solver_.eigenvectors().transpose() * wanted;
    for (int k = 0; k < Fields; ++k) {
      const double own = solver_.eigenvalues()[k];
      of_modes[k] = own > kTellsApart ? of_modes[k] / own : 0;
    }
    const Values factors = solver_.eigenvectors() * of_modes;
    std::vector<double> weights;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const Values rest = values_[k] - linear_of_fields_.transpose() * linear_part(places_[k]);
      weights.push_back(nearness(places_[k]) * rest.dot(factors));
    }
    return weights;
  }

 private:
  using Mixed = Eigen::Matrix<double, 3, Fields>;
  using Square = Eigen::Matrix<double, Fields, Fields>;

  static Eigen::Vector3d linear_part(const Eigen::Vector2d& p) { return {1, p[0], p[1]}; }
  static double nearness(const Eigen::Vector2d& p) {
    const double root = 1 + p.squaredNorm();
    return 1 / (root * root);
  }

  const std::vector<Eigen::Vector2d>& places_;
  const std::vector<Values>& values_;
  Mixed linear_of_fields_;
  Eigen::SelfAdjointEigenSolver<Square> solver_;
};

/// Mean of what is positive of a quantity that goes evenly from one value to another.
double mean_positive(double from, double to) {
  const double low = std::min(from, to), high = std::max(from, to);
  if (low >= 0) return 0.5 * (low + high);
  return high > 0 ? 0.5 * high * high / (high - low) : 0;
}

}  // namespace

/// Adds a share of the slope in one of its triangles.
void EdgeSlopes::add_inside(const EdgeSides& edge, const Frame& frame, std::size_t side,
                            double share, std::vector<ParticleWeight>& slope) const {
  assert(edge.triangle[side] != kNone);
  const double weight = share / frame.y[side], foot = frame.foot[side] / frame.length;
  add_weight(edge.opposite[side], weight, slope);
  add_weight(edge.ends[0], -weight * (0.5 - foot), slope);
  add_weight(edge.ends[1], -weight * (0.5 + foot), slope);
}

std::vector<ParticleWeight> EdgeSlopes::inside(const EdgeSides& edge, std::size_t side) const {
  std::vector<ParticleWeight> slope;
  add_inside(edge, frame_of(edge), side, 1, slope);
  return slope;
}

/// The mean of the slopes in both triangles, in which the curvature across drops out.
std::vector<ParticleWeight> EdgeSlopes::mean_inside(const EdgeSides& edge,
                                                    const Frame& frame) const {
  std::vector<ParticleWeight> slope;
  const double whole = frame.y[0] - frame.y[1];  // of a border edge y[1] is 0
  for (std::size_t side = 0; side < (edge.is_border() ? 1U : 2U); ++side) {
    const double share = edge.is_border() ? 1 : std::abs(frame.y[1 - side]) / whole;
    add_inside(edge, frame, side, share, slope);
  }
  return slope;
}

/// Changes a slope, by the least weights, by what fields lack.
/// @param value   of the fields at a particle, about 1 nearby
/// @param wanted  change of the slopes of the fields
template <int Fields, class ValueAt>
void EdgeSlopes::amend(const EdgeSides& edge, Frame& frame, const ValueAt& value,
                       const Eigen::Matrix<double, Fields, 1>& wanted,
                       std::vector<ParticleWeight>& slope) const {
  Members members = nearest(edge);
  std::vector<Eigen::Vector2d> places;
  std::vector<Eigen::Matrix<double, Fields, 1>> values;
  for (int round = 0;; ++round) {
    places.clear(), values.clear();
    if (frame.around) frame.around->lay_out(members);
    for (const Index i : members) {
      places.push_back(place_of(i, frame));
      values.push_back(value(i));
    }
    const FieldFit<Fields> fit(places, values);
    if (!fit.is_determined() && round < kSlopeRounds) {
      members = grown(members);
      continue;
    }
    const std::vector<double> more = fit.weights(wanted);
    for (std::size_t k = 0; k < more.size(); ++k) add_weight(members[k], more[k], slope);
    return;
  }
}

std::vector<ParticleWeight> EdgeSlopes::across(const EdgeSides& edge) const {
  Frame frame = frame_of(edge);
  std::vector<ParticleWeight> slope = mean_inside(edge, frame);
  const auto value = [&](Index i) { return squares_at(place_of(i, frame)); };
  Eigen::Vector3d wrong = Eigen::Vector3d::Zero();
  for (const ParticleWeight& one : slope) wrong += one.weight * value(one.particle);
  if (wrong.cwiseAbs().maxCoeff() * frame.height > kRightSlope)
    amend<3>(edge, frame, value, -wrong, slope);
  return slope;
}

bool EdgeSlopes::meets_held(const EdgeSides& edge, const std::vector<double>& beyond) const {
  const Members members = nearest(edge);
  return std::any_of(members.begin(), members.end(),
                     [&](Index i) { return beyond[static_cast<std::size_t>(i)] < 0; });
}

std::vector<ParticleWeight> EdgeSlopes::across_clamped(const EdgeSides& edge,
                                                       const std::vector<double>& beyond) const {
  assert(beyond.size() == x_.size());
  const auto at = [&](Index i) { return beyond[static_cast<std::size_t>(i)]; };
  Frame frame = frame_of(edge);
  std::vector<ParticleWeight> slope = mean_inside(edge, frame);
  double rise = 0;  // of the distance, across the edge
  for (const ParticleWeight& one : slope) rise += one.weight * at(one.particle);
  const double from = at(edge.ends[0]), to = at(edge.ends[1]);
  const double unit = std::hypot(rise, (to - from) / frame.length) * frame.height;
  const auto value = [&](Index i) {
    const double distance = std::max(at(i), 0.0) / unit;
    return Eigen::Matrix<double, 1, 1>(0.5 * distance * distance);
  };
  Eigen::Matrix<double, 1, 1> wrong(-rise * mean_positive(from, to) / (unit * unit));
  for (const ParticleWeight& one : slope) wrong += one.weight * value(one.particle);
  if (std::abs(wrong[0]) * frame.height > kRightSlope) amend<1>(edge, frame, value, -wrong, slope);
  return slope;
}

}  // namespace weft
