// Fits slopes across the edges of a mesh that are exact for quadratic fields.

#include "core/cloth/edge_slope.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "core/cloth/constants.h"
#include "core/cloth/field_fit.h"
#include "core/cloth/pieces.h"

namespace weft {
namespace {

std::vector<Edge> ends_of(const std::vector<EdgeSides>& edges) {
  std::vector<Edge> ends;
  for (const EdgeSides& edge : edges) ends.push_back(edge.ends);
  return ends;
}

/// Edges that share one field at most [1]. Larger: the time to build many needles in a row grows
/// with the square of their number. Smaller: the slopes of needles that share edges differ by more.
constexpr std::size_t kMostJoined = 64;

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
      neighbours_(x.size(), ends_of(edges_)), shapes_(shapes) {
  find_needles();
}

/// Coordinates in the plane of an edge, from its middle.
struct EdgeSlopes::Frame {
  Vec3d middle, along, across;
  double length = 0;                  ///< of the edge [m]
  double height = 0;                  ///< mean of its triangles' [m]
  std::array<double, 2> foot{}, y{};  ///< along and across, of the triangles' third corners [m]
  std::optional<Unfolding> around;    ///< of a mesh that is not flat as a whole
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
  const auto out = [&](std::size_t side) -> Vec3d {
    const Vec3d to = at(edge.opposite[side]) - frame.middle;
    return to - frame.along * to.dot(frame.along);
  };
  frame.across = out(0).normalized();
  // Where rounding has turned a needle over, the higher triangle says which side is which.
  if (!edge.is_border() && out(1).dot(frame.across) >= out(0).norm())
    frame.across = -out(1).normalized();
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

/// Of a particle, in the edge's plane from its middle [m].
Eigen::Vector2d EdgeSlopes::laid_out(Index particle, const Frame& frame) const {
  if (shapes_ == nullptr) {
    const Vec3d p = x_[static_cast<std::size_t>(particle)] - frame.middle;
    return {p.dot(frame.along), p.dot(frame.across)};
  }
  const Eigen::Vector2d* const place = frame.around->place(particle);
  assert(place != nullptr && "only particles that were laid out have a place");
  return *place;
}

/// The same in units of the edge's length and height [1].
Eigen::Vector2d EdgeSlopes::place_of(Index particle, const Frame& frame) const {
  const Eigen::Vector2d place = laid_out(particle, frame);
  return {place[0] / frame.length, place[1] / frame.height};
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

Eigen::Vector3d slope_of_squares(const Eigen::Vector2d& p, const Eigen::Vector2d& direction) {
  return {direction[0] * p[0], direction[0] * p[1] + direction[1] * p[0], direction[1] * p[1]};
}

/// Mean of the positive part of a quantity that changes linearly from one value to the other.
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

/// Mean of the slopes in both triangles, weighted by their heights: the difference of the third
/// corners. The curvature across cancels where the heights are equal; a low triangle has little
/// weight.
std::vector<ParticleWeight> EdgeSlopes::mean_inside(const EdgeSides& edge,
                                                    const Frame& frame) const {
  std::vector<ParticleWeight> slope;
  const double whole = frame.y[0] - frame.y[1];  // of a border edge y[1] is 0
  for (std::size_t side = 0; side < (edge.is_border() ? 1U : 2U); ++side) {
    add_inside(edge, frame, side, (side == 0 ? frame.y[0] : -frame.y[1]) / whole, slope);
  }
  return slope;
}

/// Fits fields to particles around an edge, and adds neighbours until these distinguish the fields.
/// @param value    of the fields at a particle, about 1 nearby
/// @param members  to begin with; receives those of the fit
template <int Fields, class ValueAt>
FieldFit<Fields> EdgeSlopes::fit_around(Frame& frame, const ValueAt& value,
                                        Members& members) const {
  for (int round = 0;; ++round) {
    if (frame.around) frame.around->lay_out(members);
    std::vector<Eigen::Vector2d> places;
    std::vector<Eigen::Matrix<double, Fields, 1>> values;
    for (const Index i : members) {
      places.push_back(place_of(i, frame));
      values.push_back(value(i));
    }
    FieldFit<Fields> fit(std::move(places), std::move(values));
    if (fit.is_determined() || round == kSlopeRounds) return fit;
    members = grown(members);
  }
}

/// Corrects a slope by the least weights that make it right for some fields.
/// @param value   as above
/// @param wanted  change of the slopes of the fields
template <int Fields, class ValueAt>
void EdgeSlopes::amend(const EdgeSides& edge, Frame& frame, const ValueAt& value,
                       const Eigen::Matrix<double, Fields, 1>& wanted,
                       std::vector<ParticleWeight>& slope) const {
  Members members = nearest(edge);
  const std::vector<double> more = fit_around<Fields>(frame, value, members).weights(wanted);
  for (std::size_t k = 0; k < more.size(); ++k) add_weight(members[k], more[k], slope);
}

std::vector<ParticleWeight> EdgeSlopes::across(std::size_t number) const {
  assert(number < edges_.size());
  if (needle_of_[number] != kNone)
    return across_best_fit(number, needles_[static_cast<std::size_t>(needle_of_[number])]);
  const EdgeSides& edge = edges_[number];
  Frame frame = frame_of(edge);
  std::vector<ParticleWeight> slope = mean_inside(edge, frame);
  const auto value = [&](Index i) { return squares_at(place_of(i, frame)); };
  Eigen::Vector3d wrong = Eigen::Vector3d::Zero();
  for (const ParticleWeight& one : slope) wrong += one.weight * value(one.particle);
  if (wrong.cwiseAbs().maxCoeff() * frame.height > kRightSlope)
    amend<3>(edge, frame, value, -wrong, slope);
  Members members;
  double largest = 0;
  for (const ParticleWeight& one : slope) {
    members.push_back(one.particle);
    largest = std::max(largest, std::abs(one.weight));
  }
  if (largest * spread(members, frame) < kMostSlopeWeight) return slope;
  return across_best_fit(number, {static_cast<Index>(number)});
}

/// The slope of the quadratic field that fits best around some edges, one of which it is.
std::vector<ParticleWeight> EdgeSlopes::across_best_fit(std::size_t number,
                                                        const std::vector<Index>& edges) const {
  const EdgeSides& edge = edges_[number];
  Frame frame = frame_of(edges_[static_cast<std::size_t>(edges.front())]);
  Members members = {edge.ends[0], edge.ends[1], edge.opposite[0]};
  if (frame.around) frame.around->lay_out(members);
  if (members.size() < 3) return across_best_fit(number, {static_cast<Index>(number)});
  for (const Index e : edges) {
    for (const Index i : nearest(edges_[static_cast<std::size_t>(e)])) add_member(i, members);
  }
  if (frame.around) frame.around->lay_out(members);
  frame.length = frame.height = spread(members, frame);
  const auto value = [&](Index i) { return squares_at(place_of(i, frame)); };
  const FieldFit<3> fit = fit_around<3>(frame, value, members);
  const Eigen::Vector2d from = place_of(edge.ends[0], frame), to = place_of(edge.ends[1], frame),
                        middle = 0.5 * (from + to);
  Eigen::Vector2d in = Eigen::Vector2d(from[1] - to[1], to[0] - from[0]).normalized();
  const auto height = [&](std::size_t side) {
    return in.dot(place_of(edge.opposite[side], frame) - middle);
  };
  const bool by_both = shapes_ == nullptr && !edge.is_border();
  if (height(0) - (by_both ? height(1) : 0) < 0) in = -in;
  const std::vector<double> weights = fit.slope(in, slope_of_squares(middle, in));
  std::vector<ParticleWeight> slope;
  for (std::size_t k = 0; k < weights.size(); ++k)
    slope.push_back({members[k], weights[k] / frame.length});
  return slope;
}

/// How far an edge's particles lie from its middle: the root of the mean square [m].
double EdgeSlopes::spread(const Members& members, const Frame& frame) const {
  double square = 0;
  for (const Index i : members) square += laid_out(i, frame).squaredNorm();
  return std::sqrt(square / static_cast<double>(members.size()));
}

/// Height of a triangle over an edge, relative to how far the particles nearest to the edge reach
/// from its line [1].
double EdgeSlopes::lowness(std::size_t number, Index triangle) const {
  const EdgeSides& edge = edges_[number];
  Frame frame = frame_of(edge);
  Members members = nearest(edge);
  if (frame.around) frame.around->lay_out(members);
  double reach = 0;
  for (const Index i : members) reach = std::max(reach, std::abs(laid_out(i, frame)[1]));
  return std::abs(frame.y[edge.triangle[0] == triangle ? 0 : 1]) / reach;
}

/// Joins the long edges of each triangle that is a needle beside what lies around it.
void EdgeSlopes::find_needles() {
  std::vector<Edge> joins;
  for (std::size_t t = 0; t < of_.size(); ++t) {
    Index first = kNone;
    for (const Index e : of_[t]) {
      if (lowness(static_cast<std::size_t>(e), static_cast<Index>(t)) >= kNeedle) continue;
      if (first == kNone) first = e;
      joins.push_back({first, e});
    }
  }
  needle_of_.assign(edges_.size(), kNone);
  const std::vector<Index> roots = pieces_along(joins, edges_.size());
  for (const Edge& join : joins) {
    for (const Index e : join) {
      Index& root = needle_of_[static_cast<std::size_t>(roots[static_cast<std::size_t>(e)])];
      if (root == kNone) {
        root = static_cast<Index>(needles_.size());
        needles_.emplace_back();
      }
      needle_of_[static_cast<std::size_t>(e)] = root;
      std::vector<Index>& needle = needles_[static_cast<std::size_t>(root)];
      if (needle.size() <= kMostJoined) add_member(e, needle);
    }
  }
  for (Index& needle : needle_of_) {
    if (needle != kNone && needles_[static_cast<std::size_t>(needle)].size() > kMostJoined)
      needle = kNone;
  }
}

bool EdgeSlopes::goes_into(std::size_t edge, std::size_t side) const {
  assert(edge < edges_.size() && edges_[edge].triangle[side] != kNone);
  return shapes_ == nullptr ? frame_of(edges_[edge]).y[side] > 0 : side == 0;
}

bool EdgeSlopes::meets_held(const EdgeSides& edge, const std::vector<double>& beyond) const {
  assert(beyond.size() == x_.size());
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
