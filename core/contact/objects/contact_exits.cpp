// Cloth that starts inside an object: found, and led out as a whole.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/objects/contact.h"

namespace weft {
namespace {

/// Where nothing is near [m].
constexpr double kFar = 1000;

/// Steps of the search for the surface, and the least length of one [m].
constexpr int kMostSteps = 64;
constexpr double kLeastStep = 1e-4;

/// Triangles whose mean normal is longer than this lie alike; a direction counts if it is longer
/// than this part of what it could be.
constexpr double kAlike = 0.3, kDecided = 0.1;

}  // namespace

/// Signed distance of a point from the solid shape of one collider [m]; far from it, and from what
/// has no inside, a large number.
template <class Real>
Real Contact<Real>::distance_from(std::size_t collider, const Vec3<Real>& p) const {
  Real nearest = Real(kFar);
  for (const Ball& ball : balls_) {
    if (ball.collider == collider)
      nearest = std::min(nearest, (p - ball.centre).norm() - ball.radius);
  }
  for (const Rod& rod : rods_) {
    if (rod.collider != collider) continue;
    const Vec3<Real> q = rod.a + (rod.b - rod.a) * closest_on_segment(p, rod.a, rod.b);
    nearest = std::min(nearest, (p - q).norm() - rod.radius);
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    if (mesh_collider_[m] != collider || !meshes_[m].closed) continue;
    nearest = std::min(nearest,
                       distance_to_mesh(meshes_[m], frames_[collider].own(p), Real(kFar)).distance);
  }
  return nearest;
}

template <class Real>
Real Contact<Real>::gap_of(const ContactRow<Real>& row, const Vec3Array<Real>& x) const {
  Vec3<Real> p = Vec3<Real>::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k)
    p += x[static_cast<std::size_t>(row.particle[k])] * row.weight[k];
  const Real distance = distance_from(static_cast<std::size_t>(row.collider), p);
  return distance < Real(kFar) ? distance : row.normal.dot(p) - row.offset;
}

template <class Real>
void Contact<Real>::note_inside(Index particle, std::size_t collider) {
  Index& known = inside_[static_cast<std::size_t>(particle)];
  const auto number = static_cast<Index>(collider);
  known = known == kOutside || known == number ? number : kInsideSeveral;
}

template <class Real>
bool Contact<Real>::is_inside(Index particle, std::size_t collider) const {
  const Index known = inside_[static_cast<std::size_t>(particle)];
  return known == static_cast<Index>(collider) || known == kInsideSeveral;
}

/// Whether a particle's cloth is just leaving an object in which it started: what cuts a corner of
/// that goes on outward.
template <class Real>
bool Contact<Real>::still_leaves(Index particle, std::size_t collider) {
  for (BadStart<Real>& exit : exits_) {
    if (exit.collider != collider || exit.cloth != cloth_of(particle)) continue;
    ++exit.particles;
    return true;
  }
  return false;
}

/// Adds the row of a particle inside a solid. Pressed in a little it goes back to the nearest
/// surface. What started inside is led out in one direction with all of the cloth that is inside
/// too: the ways to the nearest surface would part it on two sides.
template <class Real>
void Contact<Real>::add_inside(const ClothState<Real>& state, Index i, const Vec3<Real>& normal,
                               Real distance, std::size_t collider) {
  const Index cloth = cloth_of(i);
  auto exit = std::find_if(exits_.begin(), exits_.end(), [&](const BadStart<Real>& e) {
    return e.collider == collider && e.cloth == cloth;
  });
  const auto add = [&](const Vec3<Real>& outward, Real from) {
    const Vec3d n = outward.template cast<double>();
    const double height = n.dot(state.x[static_cast<std::size_t>(i)].template cast<double>());
    const double top = height - static_cast<double>(from);
    add_row(state, {i}, {Real(1), 0, 0}, {outward, top, from}, collider);
  };
  if (exit == exits_.end()) {
    const Real thickness = static_cast<Real>(cloths_[static_cast<std::size_t>(cloth)].thickness);
    if (!(distance < -thickness)) return add(normal, distance);
    exits_.push_back({collider, cloth, find_way_out(state, collider, cloth), 0});
    exit = exits_.end() - 1;
  }
  ++exit->particles;
  const auto p = static_cast<std::size_t>(i);
  note_inside(i, collider);
  const Vec3<Real>& x = state.x[p];
  Real way = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    const Real left = -distance_from(collider, x + exit->direction * way);
    if (!(left > 0)) break;
    way += std::max(left, static_cast<Real>(kLeastStep));
  }
  add(exit->direction, -way);
}

/// The direction in which the part of a cloth that is inside an object leaves it: across the cloth,
/// so that it need not be gathered up, to the side on which more of it is nearer to the surface; a
/// crumpled one as its particles would by themselves; up, if nothing else tells.
template <class Real>
Vec3<Real> Contact<Real>::find_way_out(const ClothState<Real>& state, std::size_t collider,
                                       Index cloth) const {
  std::vector<char> is_inside(state.x.size(), 0);
  Vec3<Real> outward = Vec3<Real>::Zero();
  Real count = 0;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (cloth_of(static_cast<Index>(i)) != cloth) continue;
    const Vec3<Real>& x = state.x[i];
    const Real distance = distance_from(collider, x);
    if (!(distance < 0)) continue;
    is_inside[i] = 1;
    // The gradient of the distance, by differences: it only has to tell a side.
    const Real h = std::max(-distance * Real(0.01), static_cast<Real>(kLeastStep));
    Vec3<Real> gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3<Real> off = Vec3<Real>::Zero();
      off[axis] = h;
      gradient[axis] = distance_from(collider, x + off) - distance_from(collider, x - off);
    }
    const Real length = gradient.norm();
    if (length > 0) outward += gradient / length;
    count += 1;
  }
  Vec3<Real> normals = Vec3<Real>::Zero();
  Real area = 0;
  for (const Triangle& t : patches_.triangles) {
    const auto at = [&](std::size_t k) { return static_cast<std::size_t>(t[k]); };
    if (!is_inside[at(0)] && !is_inside[at(1)] && !is_inside[at(2)]) continue;
    const Vec3<Real> n = (state.x[at(1)] - state.x[at(0)]).cross(state.x[at(2)] - state.x[at(0)]);
    normals += n;
    area += n.norm();
  }
  const auto sided = [](const Vec3<Real>& d, Real side) -> Vec3<Real> {
    return side < 0 ? (-d).eval() : d;
  };
  if (normals.norm() > area * static_cast<Real>(kAlike)) {
    const Vec3<Real> across = normals.normalized();
    const Real side = across.dot(outward);
    const bool decided = std::abs(side) > count * static_cast<Real>(kDecided);
    return sided(across, decided ? side : across[1]);
  }
  if (outward.norm() > count * static_cast<Real>(kDecided)) return outward.normalized();
  return Vec3<Real>::UnitY();
}

#define WEFT_INSTANTIATE(Real)                                                                     \
  template void Contact<Real>::note_inside(Index, std::size_t);                                    \
  template bool Contact<Real>::is_inside(Index, std::size_t) const;                                \
  template bool Contact<Real>::still_leaves(Index, std::size_t);                                   \
  template Real Contact<Real>::distance_from(std::size_t, const Vec3<Real>&) const;                \
  template Real Contact<Real>::gap_of(const ContactRow<Real>&, const Vec3Array<Real>&) const;      \
  template void Contact<Real>::add_inside(const ClothState<Real>&, Index, const Vec3<Real>&, Real, \
                                          std::size_t);                                            \
  template Vec3<Real> Contact<Real>::find_way_out(const ClothState<Real>&, std::size_t, Index)     \
      const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
