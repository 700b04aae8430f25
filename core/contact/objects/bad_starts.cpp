// Chooses the direction in which cloth leaves an object that it started in.

#include "core/contact/objects/bad_starts.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/contact/objects/constants.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// The part of a cloth that is inside an object.
template <class Real>
struct InsidePart {
  std::vector<char> has;                    ///< of each particle
  Vec3<Real> outward = Vec3<Real>::Zero();  ///< sum of directions to the nearest surface
  Real count = 0;                           ///< of particles
};

template <class Real>
InsidePart<Real> find_inside_part(const ObjectRowSource<Real>& source, std::size_t collider,
                                  Index cloth) {
  const Vec3Array<Real>& positions = source.state.x;
  InsidePart<Real> part;
  part.has.assign(positions.size(), 0);
  const auto distance_at = [&](const Vec3<Real>& p) {
    return distance_from(source.shapes, collider, p);
  };
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (cloth_of(source.cloths, static_cast<Index>(i)) != cloth) continue;
    const Vec3<Real>& x = positions[i];
    const Real distance = distance_at(x);
    if (!(distance < 0)) continue;
    part.has[i] = 1;
    // The gradient of the distance, by differences: it only has to tell a side.
    const Real h = std::max(-distance * Real(0.01), static_cast<Real>(kLeastSurfaceStep));
    Vec3<Real> gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3<Real> off = Vec3<Real>::Zero();
      off[axis] = h;
      gradient[axis] = distance_at(x + off) - distance_at(x - off);
    }
    const Real length = gradient.norm();
    if (length > 0) part.outward += gradient / length;
    part.count += 1;
  }
  return part;
}

/// The direction in which the part of a cloth that is inside an object leaves it: across the cloth,
/// so that it need not be gathered up, to the side on which more of it is nearer to the surface; a
/// crumpled one as its particles would by themselves; up, if nothing else tells.
template <class Real>
Vec3<Real> find_way_out(const ObjectRowSource<Real>& source, std::size_t collider, Index cloth) {
  const Vec3Array<Real>& x = source.state.x;
  const InsidePart<Real> part = find_inside_part(source, collider, cloth);
  Vec3<Real> normals = Vec3<Real>::Zero();
  Real area = 0;
  for (const Triangle& t : source.cloths.patches.triangles) {
    const auto at = [&](std::size_t k) { return at_index(t[k]); };
    if (!part.has[at(0)] && !part.has[at(1)] && !part.has[at(2)]) continue;
    const Vec3<Real> n = (x[at(1)] - x[at(0)]).cross(x[at(2)] - x[at(0)]);
    normals += n;
    area += n.norm();
  }
  const auto sided = [](const Vec3<Real>& d, Real side) -> Vec3<Real> {
    return side < 0 ? (-d).eval() : d;
  };
  if (normals.norm() > area * static_cast<Real>(kAlike)) {
    const Vec3<Real> across = normals.normalized();
    const Real side = across.dot(part.outward);
    const bool decided = std::abs(side) > part.count * static_cast<Real>(kDecided);
    return sided(across, decided ? side : across[1]);
  }
  if (part.outward.norm() > part.count * static_cast<Real>(kDecided))
    return part.outward.normalized();
  return Vec3<Real>::UnitY();
}

/// How far a point has to go in a direction until it is outside of a collider [m].
template <class Real>
Real distance_out(const ObjectShapes<Real>& shapes, std::size_t collider, const Vec3<Real>& x,
                  const Vec3<Real>& direction) {
  Real gone = 0;
  for (int step = 0; step < kMostSurfaceSteps; ++step) {
    const Real left = -distance_from<Real>(shapes, collider, x + direction * gone);
    if (!(left > 0)) break;
    gone += std::max(left, static_cast<Real>(kLeastSurfaceStep));
  }
  return gone;
}

}  // namespace

template <class Real>
bool still_leaves(Index cloth, std::size_t collider, std::vector<BadStart<Real>>& exits) {
  for (BadStart<Real>& exit : exits) {
    if (exit.collider != collider || exit.cloth != cloth) continue;
    ++exit.particles;
    return true;
  }
  return false;
}

template <class Real>
void add_inside(const ObjectRowSource<Real>& source, Index i, const Vec3<Real>& normal,
                Real distance, std::size_t collider, std::vector<Index>& inside,
                RowList<Real>& rows) {
  assert(distance < 0);
  const Index cloth = cloth_of(source.cloths, i);
  const Vec3<Real>& x = source.state.x[at_index(i)];
  const ColliderFrame<Real>& frame = source.shapes.frames[collider];
  auto exit = std::find_if(rows.exits.begin(), rows.exits.end(), [&](const BadStart<Real>& e) {
    return e.collider == collider && e.cloth == cloth;
  });
  const auto add = [&](const Vec3<Real>& outward, Real from) {
    const double height = outward.template cast<double>().dot(x.template cast<double>());
    const double top = height - static_cast<double>(from);
    add_row(source, {i}, {Real(1), 0, 0}, {outward, top, from}, collider, true, rows);
  };
  if (exit == rows.exits.end()) {
    if (!(distance < -thickness_at(source.cloths, i))) return add(normal, distance);
    const Vec3<Real> way = find_way_out(source, collider, cloth);
    rows.exits.push_back({collider, cloth, frame.own_direction(way), 0});
    exit = rows.exits.end() - 1;
  }
  ++exit->particles;
  note_inside(i, collider, inside);
  const Vec3<Real> way = frame.world_direction(exit->direction);
  add(way, -distance_out(source.shapes, collider, x, way));
}

WEFT_INSTANTIATE_FUNCTIONS(still_leaves, add_inside)

}  // namespace weft
