// Searches for crossings and frees the pairs around contours.

#include "core/contact/tangles/cloth_tangles.h"

#include <algorithm>
#include <cassert>

#include "core/math/exact_sign.h"

namespace weft {
namespace {

/// Contours beyond this number share bits of particles, which frees more pairs than necessary.
constexpr std::size_t kBits = 64;

/// Exact sign of how p q passes edge a b, independent of the order of a and b, and never 0.
int side_of_line(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, bool in_order) {
  const int sign = in_order ? orientation(p, q, a, b) : -orientation(p, q, b, a);
  if (sign != 0) return sign;
  return in_order ? 1 : -1;
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
void ClothTangles<Real>::reset() {
  clear();
  drawn_ = 0;
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
  assert(static_cast<std::size_t>(edge) < edges_.size());
  assert(static_cast<std::size_t>(triangle) < triangles_.size());
  const Edge& e = edges_[static_cast<std::size_t>(edge)];
  const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
  assert(std::find(t.begin(), t.end(), e[0]) == t.end());
  assert(std::find(t.begin(), t.end(), e[1]) == t.end());
  const Vec3d p = at(e[0], x), q = at(e[1], x), a = at(t[0], x), b = at(t[1], x), c = at(t[2], x);
  // A point exactly in the plane counts as above it, so that neighbouring triangles agree.
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
  assert(inverse_mass.size() == is_held_.size());
  rows_.clear();
  if (crossings_.empty()) {
    drawn_ = 0;
    return;
  }
  if (rows_.capacity() < 2 * crossings_.size()) {
    rows_.reserve(4 * crossings_.size());
    crossings_.reserve(4 * crossings_.size());
  }
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
  assert(number < contours_.list().size());
  const std::uint64_t bit = std::uint64_t{1} << (number % kBits);
  for (std::size_t k = contour.free_begin; k < contour.free_end; ++k) {
    const TangleContours::Free& free = contours_.free()[k];
    near_[free.sheet][static_cast<std::size_t>(free.particle)] |= bit;
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

template class ClothTangles<float>;
template class ClothTangles<double>;

}  // namespace weft
