// Pulls crossings apart: impulses of ClothTangles on edges and triangles.

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/contact/tangles/cloth_tangles.h"
#include "core/contact/tangles/constants.h"

namespace weft {
namespace {

Vec3d unit(const Vec3d& v) {
  const double length = v.norm();
  return length > 0 ? Vec3d(v / length) : Vec3d(Vec3d::UnitY());
}

}  // namespace

template <class Real>
Vec3d ClothTangles<Real>::normal_of(Index triangle, const QuadArray<Real>& x) const {
  const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
  const Vec3d a = at(t[0], x);
  return unit((at(t[1], x) - a).cross(at(t[2], x) - a));
}

template <class Real>
Vec3d ClothTangles<Real>::normal_at(Index edge, const QuadArray<Real>& x) const {
  Vec3d sum = Vec3d::Zero();
  for (const Index t : contours_.triangles_of(edge)) {
    if (t != kNone) sum += normal_of(t, x);
  }
  return unit(sum);
}

template <class Real>
Vec3d ClothTangles<Real>::point_of(const TangleCrossing& crossing, const QuadArray<Real>& x) const {
  const Edge& e = edges_[static_cast<std::size_t>(crossing.edge)];
  return at(e[0], x) + (at(e[1], x) - at(e[0], x)) * crossing.along;
}

/// Direction of a contour at one of its crossings.
template <class Real>
Vec3d ClothTangles<Real>::direction_along(const TangleContour& contour, std::size_t place,
                                          const QuadArray<Real>& x) const {
  assert(place >= contour.begin && place < contour.end);
  const auto crossing = [&](std::size_t k) -> const TangleCrossing& {
    return crossings_[static_cast<std::size_t>(contours_.order()[k])];
  };
  // If it ends in a fold, that is its last point.
  const auto end = [&](std::size_t k) {
    const Index fold = contours_.fold_at(crossing(k));
    return fold != kNone ? at(fold, x) : point_of(crossing(k), x);
  };
  const bool first = place == contour.begin, last = place + 1 == contour.end;
  const Vec3d from =
      first ? (last ? point_of(crossing(place), x) : end(place)) : point_of(crossing(place - 1), x);
  const Vec3d to = last ? end(place) : point_of(crossing(place + 1), x);
  return unit(to - from);
}

/// Records the positions of a new row's features.
template <class Real>
void ClothTangles<Real>::place(Row& row, const QuadArray<Real>& x) const {
  row.apart = Vec3<Real>::Zero();
  for (std::size_t k = 0; k < 5; ++k)
    row.apart += to_vector(x[static_cast<std::size_t>(row.particle[k])]) * row.weight[k];
}

template <class Real>
void ClothTangles<Real>::add_rows(const TangleContour& contour, const QuadArray<Real>& x) {
  for (std::size_t k = contour.begin; k < contour.end; ++k) {
    const TangleCrossing& c = crossings_[static_cast<std::size_t>(contours_.order()[k])];
    // The direction in which the edge has to move past the triangle.
    Vec3d direction = Vec3d::Zero();
    const bool edge_moves = c.side == contour.sheet;
    switch (contour.motion) {
      case TangleMotion::slide:
        direction = direction_along(contour, k, x) * (edge_moves ? 1 : -1);
        break;
      case TangleMotion::back:
        direction = edge_moves ? Vec3d(normal_of(c.triangle, x) * -contour.wrong)
                               : Vec3d(normal_at(c.edge, x) * contour.wrong);
        break;
      case TangleMotion::unfold:
        direction = unit(normal_at(c.edge, x) - normal_of(c.triangle, x)) * contour.wrong;
        break;
    }
    Row row;
    const Edge& e = edges_[static_cast<std::size_t>(c.edge)];
    const Triangle& t = triangles_[static_cast<std::size_t>(c.triangle)];
    row.particle = {e[0], e[1], t[0], t[1], t[2]};
    row.weight = {static_cast<Real>(1 - c.along), static_cast<Real>(c.along)};
    for (std::size_t m = 0; m < 3; ++m) row.weight[2 + m] = -static_cast<Real>(c.barycentric[m]);
    row.direction = direction.template cast<Real>();
    row.wanted =
        static_cast<Real>(contour.motion == TangleMotion::unfold ? kUnfoldSpeed : kDrawSpeed);
    place(row, x);
    rows_.push_back(row);
  }
}

template <class Real>
void ClothTangles<Real>::note_touch(PairKind kind, const std::array<Index, 4>& particle,
                                    const QuadArray<Real>& x) {
  const std::size_t middle = first_side(kind);
  // Away from the sheet that comes first, on the side of its normals: the same all along it.
  const bool first = particle[0] < particle[middle];
  const Index of = first ? particle[0] : particle[middle];
  Row row;
  for (std::size_t k = 0; k < 4; ++k) {
    row.particle[k] = particle[k];
    const auto own = static_cast<Real>(k < middle ? middle : 4 - middle);
    row.weight[k] = (k < middle ? 1 : -1) / own;
  }
  row.particle[4] = particle[3];
  row.wanted = static_cast<Real>(kDrawSpeed);
  const Vec3d normal = normal_of(triangle_at_[static_cast<std::size_t>(of)], x);
  row.direction = (first ? Vec3d(-normal) : normal).template cast<Real>();
  place(row, x);
  rows_.push_back(row);
}

/// Speed at which the features of a row separate along its direction [m/s].
template <class Real>
Real ClothTangles<Real>::speed_of(const Row& row, const ClothState<Real>& state) const {
  Real speed = 0;
  for (std::size_t k = 0; k < 5; ++k)
    speed += row.weight[k] * row.direction.dot(state.v[static_cast<std::size_t>(row.particle[k])]);
  return speed;
}

/// Starts a step: updates the mobility of the features, and their speed in the last drift.
template <class Real>
void ClothTangles<Real>::begin_row(Row& row, const ClothState<Real>& state, Real dt) const {
  Real mobility = 0;
  Vec3<Real> apart = Vec3<Real>::Zero();
  for (std::size_t k = 0; k < 5; ++k) {
    const auto i = static_cast<std::size_t>(row.particle[k]);
    mobility += row.weight[k] * row.weight[k] * state.inverse_mass[i];
    apart += state.x[i] * row.weight[k];
  }
  row.inertia = mobility > 0 ? 1 / mobility : Real(0);
  row.speed = row.direction.dot(apart - row.apart) / dt;
  row.apart = apart;
  row.pull = 0;
}

template <class Real>
void ClothTangles<Real>::draw(ClothState<Real>& state, Real dt) {
  assert(dt > 0);
  if (rows_.empty()) return;
  assert(state.x.size() == is_held_.size() && state.v.size() == is_held_.size());
  drawn_ += static_cast<double>(dt);
  const double age2 = drawn_ * drawn_ / (kDrawPatience * kDrawPatience);
  const auto most = static_cast<Real>(kMostDrawAcceleration / (1 + age2 * age2)) * dt;
  for (Row& row : rows_) begin_row(row, state, dt);
  for (int sweep = 0; sweep < kDrawSweeps; ++sweep) {
    for (Row& row : rows_) {
      const Real wanted = row.pull + (row.wanted - speed_of(row, state)) * row.inertia;
      const Real pull = std::clamp(wanted, Real(0), row.inertia * most);
      const Real more = pull - std::exchange(row.pull, pull);
      if (more == 0) continue;
      for (std::size_t k = 0; k < 5; ++k) {
        const auto i = static_cast<std::size_t>(row.particle[k]);
        state.v[i] += row.direction * (more * row.weight[k] * state.inverse_mass[i]);
      }
    }
  }
  // The mean of the speeds in the previous and the next drift, because leapfrog has none between.
  for (const Row& row : rows_)
    work_ += static_cast<double>(row.pull * (row.speed + speed_of(row, state)) / 2);
}

#define WEFT_INSTANTIATE(Real)                                                               \
  template Vec3d ClothTangles<Real>::normal_of(Index, const QuadArray<Real>&) const;         \
  template Vec3d ClothTangles<Real>::normal_at(Index, const QuadArray<Real>&) const;         \
  template Vec3d ClothTangles<Real>::point_of(const TangleCrossing&, const QuadArray<Real>&) \
      const;                                                                                 \
  template Vec3d ClothTangles<Real>::direction_along(const TangleContour&, std::size_t,      \
                                                     const QuadArray<Real>&) const;          \
  template void ClothTangles<Real>::place(Row&, const QuadArray<Real>&) const;               \
  template Real ClothTangles<Real>::speed_of(const Row&, const ClothState<Real>&) const;     \
  template void ClothTangles<Real>::begin_row(Row&, const ClothState<Real>&, Real) const;    \
  template void ClothTangles<Real>::add_rows(const TangleContour&, const QuadArray<Real>&);  \
  template void ClothTangles<Real>::note_touch(PairKind, const std::array<Index, 4>&,        \
                                               const QuadArray<Real>&);                      \
  template void ClothTangles<Real>::draw(ClothState<Real>&, Real);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
