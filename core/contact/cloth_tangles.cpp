#include "core/contact/cloth_tangles.h"

#include <algorithm>

#include "core/math/exact_sign.h"

namespace weft {
namespace {

/// Speed at which edge and triangle are drawn past each other [m/s], and the largest acceleration
/// that this may take [m/s^2]: that of a fold drawn through by its rim alone.
constexpr double kDrawSpeed = 0.5, kMostAcceleration = 2000;

/// Sweeps over the rows a step.
constexpr int kSweeps = 2;

/// Particles so many edges away from a contour are free on its account.
constexpr int kRings = 2;

/// Contours share the bits of particles beyond this number: more is free then than has to be.
constexpr std::size_t kBits = 64;

/// Exact sign of how p q passes edge a b, the same whichever way a b is written, and never 0.
int side_of_line(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, bool in_order) {
  const int sign = in_order ? orientation(p, q, a, b) : -orientation(p, q, b, a);
  if (sign != 0) return sign;
  return in_order ? 1 : -1;
}

Vec3d unit(const Vec3d& v) {
  const double length = v.norm();
  return length > 0 ? Vec3d(v / length) : Vec3d(Vec3d::UnitY());
}

}  // namespace

template <class Real>
ClothTangles<Real>::ClothTangles(const ClothModel<Real>& model)
    : edges_(model.edges), triangles_(model.triangles), contours_(model) {
  triangle_at_.assign(model.mass.size(), kNone);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const Index i : triangles_[t])
      triangle_at_[static_cast<std::size_t>(i)] = static_cast<Index>(t);
  }
  is_held_.assign(model.mass.size(), 0);
  for (auto& near : near_) near.assign(model.mass.size(), 0);
}

template <class Real>
void ClothTangles<Real>::clear() {
  if (!crossings_.empty()) {
    for (auto& near : near_) near.assign(near.size(), 0);
  }
  crossings_.clear();
  rows_.clear();
}

template <class Real>
void ClothTangles<Real>::look_at(Index edge, Index triangle, const QuadArray<Real>& x) {
  const Edge& e = edges_[static_cast<std::size_t>(edge)];
  const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
  const Vec3d p = at(e[0], x), q = at(e[1], x), a = at(t[0], x), b = at(t[1], x), c = at(t[2], x);
  // What lies exactly in the plane counts as above it, so that neighbours agree.
  const bool above = orientation(a, b, c, p) <= 0;
  if (above == (orientation(a, b, c, q) <= 0)) return;
  const int ab = side_of_line(p, q, a, b, t[0] < t[1]), bc = side_of_line(p, q, b, c, t[1] < t[2]),
            ca = side_of_line(p, q, c, a, t[2] < t[0]);
  if (ab != bc || bc != ca) return;
  TangleCrossing crossing;
  crossing.edge = edge;
  crossing.triangle = triangle;
  crossing.above = above;
  const Vec3d normal = (b - a).cross(c - a);
  const double from = normal.dot(p - a), to = normal.dot(q - a), size = normal.squaredNorm();
  crossing.along = from != to ? std::clamp(from / (from - to), 0.0, 1.0) : 0.5;
  const Vec3d point = p + (q - p) * crossing.along;
  crossing.barycentric = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  if (size > 0) {
    const double wb = std::clamp((point - a).cross(c - a).dot(normal) / size, 0.0, 1.0);
    const double wc = std::clamp((b - a).cross(point - a).dot(normal) / size, 0.0, 1 - wb);
    crossing.barycentric = {1 - wb - wc, wb, wc};
  }
  crossings_.push_back(crossing);
}

template <class Real>
void ClothTangles<Real>::decide(const QuadArray<Real>& x, const std::vector<Real>& inverse_mass) {
  rows_.clear();
  if (crossings_.empty()) return;
  for (std::size_t i = 0; i < is_held_.size(); ++i) is_held_[i] = inverse_mass[i] == 0 ? 1 : 0;
  contours_.join(crossings_, is_held_);
  for (const TangleContour& contour : contours_.list()) {
    free_around(contour);
    add_rows(contour, x);
  }
}

/// Marks the particles of both sheets near a contour.
template <class Real>
void ClothTangles<Real>::free_around(const TangleContour& contour) {
  const auto number = static_cast<std::size_t>(&contour - contours_.list().data());
  const std::uint64_t bit = std::uint64_t{1} << (number % kBits);
  for (std::uint8_t sheet = 0; sheet < 2; ++sheet) {
    std::vector<std::uint64_t>& near = near_[sheet];
    ring_.clear();
    const auto mark = [&](Index i) {
      if ((near[static_cast<std::size_t>(i)] & bit) != 0) return;
      near[static_cast<std::size_t>(i)] |= bit;
      ring_.push_back(i);
    };
    for (std::size_t k = contour.begin; k < contour.end; ++k) {
      const TangleCrossing& c = crossings_[static_cast<std::size_t>(contours_.order()[k])];
      if (c.side == sheet) {
        for (const Index i : edges_[static_cast<std::size_t>(c.edge)]) mark(i);
      } else {
        for (const Index i : triangles_[static_cast<std::size_t>(c.triangle)]) mark(i);
      }
    }
    std::size_t first = 0;
    for (int ring = 0; ring < kRings; ++ring) {
      const std::size_t end = ring_.size();
      for (; first < end; ++first) contours_.regions().for_neighbours(ring_[first], mark);
    }
  }
}

template <class Real>
bool ClothTangles<Real>::frees(PairKind kind, const std::array<Index, 4>& particle) const {
  if (crossings_.empty()) return false;
  std::uint64_t sheets[2][2] = {{0, 0}, {0, 0}};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(particle[k]);
    auto& side = sheets[k < first_side(kind) ? 0 : 1];
    for (std::size_t sheet = 0; sheet < 2; ++sheet) side[sheet] |= near_[sheet][i];
  }
  return ((sheets[0][0] & sheets[1][1]) | (sheets[0][1] & sheets[1][0])) != 0;
}

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
Vec3d ClothTangles<Real>::point_of(const TangleCrossing& crossing,
                                   const QuadArray<Real>& x) const {
  const Edge& e = edges_[static_cast<std::size_t>(crossing.edge)];
  return at(e[0], x) + (at(e[1], x) - at(e[0], x)) * crossing.along;
}

/// Direction of a contour at one of its crossings.
template <class Real>
Vec3d ClothTangles<Real>::way_along(const TangleContour& contour, std::size_t place,
                                    const QuadArray<Real>& x) const {
  const auto crossing = [&](std::size_t k) -> const TangleCrossing& {
    return crossings_[static_cast<std::size_t>(contours_.order()[k])];
  };
  // Where it ends in a fold that is its last point.
  const auto end = [&](std::size_t k) {
    const Index fold = contours_.fold_at(crossing(k));
    return fold != kNone ? at(fold, x) : point_of(crossing(k), x);
  };
  const bool first = place == contour.begin, last = place + 1 == contour.end;
  const Vec3d from = first ? (last ? point_of(crossing(place), x) : end(place))
                           : point_of(crossing(place - 1), x);
  const Vec3d to = last ? end(place) : point_of(crossing(place + 1), x);
  return unit(to - from);
}

template <class Real>
void ClothTangles<Real>::add_rows(const TangleContour& contour, const QuadArray<Real>& x) {
  for (std::size_t k = contour.begin; k < contour.end; ++k) {
    const TangleCrossing& c = crossings_[static_cast<std::size_t>(contours_.order()[k])];
    // The way in which the sheet that goes has to move past the other one.
    Vec3d way;
    const bool edge_goes = c.side == (contour.wrong != 0 ? contour.sheet : contour.slides);
    if (contour.wrong == 0) {
      way = way_along(contour, k, x);
    } else {
      way = (edge_goes ? normal_of(c.triangle, x) : normal_at(c.edge, x)) * -contour.wrong;
    }
    Row row;
    const Edge& e = edges_[static_cast<std::size_t>(c.edge)];
    const Triangle& t = triangles_[static_cast<std::size_t>(c.triangle)];
    row.particle = {e[0], e[1], t[0], t[1], t[2]};
    row.weight = {static_cast<Real>(1 - c.along), static_cast<Real>(c.along)};
    for (std::size_t m = 0; m < 3; ++m) row.weight[2 + m] = -static_cast<Real>(c.barycentric[m]);
    row.direction = (edge_goes ? way : Vec3d(-way)).template cast<Real>();
    rows_.push_back(row);
  }
}

template <class Real>
void ClothTangles<Real>::note_touch(PairKind kind, const std::array<Index, 4>& particle,
                                    const QuadArray<Real>& x) {
  const std::size_t middle = first_side(kind);
  // Away from the sheet that comes first, on the side of its normals: all along it alike.
  const bool first = particle[0] < particle[middle];
  const Index of = first ? particle[0] : particle[middle];
  Row row;
  for (std::size_t k = 0; k < 4; ++k) {
    row.particle[k] = particle[k];
    const auto own = static_cast<Real>(k < middle ? middle : 4 - middle);
    row.weight[k] = (k < middle ? 1 : -1) / own;
  }
  row.particle[4] = particle[3];
  const Vec3d normal = normal_of(triangle_at_[static_cast<std::size_t>(of)], x);
  row.direction = (first ? Vec3d(-normal) : normal).template cast<Real>();
  rows_.push_back(row);
}

template <class Real>
void ClothTangles<Real>::draw(ClothState<Real>& state, Real dt) {
  for (Row& row : rows_) {
    Real mobility = 0;
    for (std::size_t k = 0; k < 5; ++k)
      mobility += row.weight[k] * row.weight[k] *
                  state.inverse_mass[static_cast<std::size_t>(row.particle[k])];
    row.inertia = mobility > 0 ? 1 / mobility : Real(0);
    row.pull = 0;
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Row& row : rows_) {
      Real speed = 0;
      for (std::size_t k = 0; k < 5; ++k)
        speed += row.weight[k] *
                 row.direction.dot(state.v[static_cast<std::size_t>(row.particle[k])]);
      const Real most = row.inertia * static_cast<Real>(kMostAcceleration) * dt;
      const Real pull = std::clamp(
          row.pull + (static_cast<Real>(kDrawSpeed) - speed) * row.inertia, Real(0), most);
      const Real more = pull - row.pull;
      if (more == 0) continue;
      row.pull = pull;
      for (std::size_t k = 0; k < 5; ++k) {
        const auto i = static_cast<std::size_t>(row.particle[k]);
        state.v[i] += row.direction * (more * row.weight[k] * state.inverse_mass[i]);
      }
      work_ += static_cast<double>(more * (speed + more / row.inertia / 2));
    }
  }
}

template class ClothTangles<float>;
template class ClothTangles<double>;

}  // namespace weft
