// Makes the rows of particles, and completes all rows.

#include "core/contact/objects/object_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/contact/objects/apart.h"
#include "core/contact/objects/bad_starts.h"
#include "core/contact/objects/constants.h"
#include "core/contact/objects/row_parts.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Whether a triangle has the corner, or both corners of the edge, that another one is nearest at.
template <class Real>
bool shares_nearest(const MeshShape<Real>& mesh, const MeshDistance<Real>& d, Index t) {
  const Triangle &own = mesh.triangles[at_index(d.triangle)], &other = mesh.triangles[at_index(t)];
  const auto has = [&](int corner) {
    return std::find(other.begin(), other.end(), own[at_index(corner % 3)]) != other.end();
  };
  if (d.feature == 0) return false;
  return d.feature <= 3 ? has(d.feature - 1) : has(d.feature - 4) && has(d.feature - 3);
}

/// Ties the row that is about to be added to its moving object.
/// @param mobility  of the row's point [1/kg]
template <class Real>
void follow(const ContactRow<Real>& row, double top, const ColliderFrame<Real>& frame,
            Real mobility, RowList<Real>& rows) {
  const Vec3d normal = row.normal.template cast<double>();
  const Vec3d shift = frame.pose.position - frame.pose.rotation * frame.pivot;
  MovingRow<Real> moving;
  moving.row = rows.all.size();
  moving.collider = at_index(row.collider);
  moving.own_normal = frame.pose.rotation.conjugate() * normal;
  moving.own_offset = top - normal.dot(shift);
  moving.mobility = mobility;
  rows.moving.push_back(moving);
}

template <class Real>
Real reach_of(const ObjectRowSource<Real>& source, Index i) {
  return source.cloths.thickness + source.reach[at_index(i)];
}

/// Finds where the pairs of near particles begin, from number `first` on.
template <class Real>
void find_cursors(const ObjectRowSource<Real>& source, std::size_t first,
                  ObjectRowPart<Real>& part) {
  part.cursor.clear();
  for (const MeshCandidates<Real>& of_mesh : source.pairs.of_mesh) {
    const auto& pairs = of_mesh.particles;  // in the order of the near particles
    const auto begin = std::partition_point(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return at_index(source.near.place[at_index(pair.cloth)]) < first;
    });
    part.cursor.push_back(static_cast<std::size_t>(begin - pairs.begin()));
  }
}

/// Finds the triangles of a mesh that a particle may touch while the rows hold.
/// @param moved  by the particle since the collection [m]
/// @return number of the nearest one in part.nearby
template <class Real>
std::size_t find_nearby(const ObjectRowSource<Real>& source, std::size_t m, Index i, Real moved,
                        ObjectRowPart<Real>& part) {
  const auto p = at_index(i);
  const Vec3<Real>& x = in_frame_of(source.shapes, source.near, m, source.state.x)[p];
  moved += source.shapes.mesh_frame(m).travel_since_pairs;
  // A particle that is inside looks for the way out, however far it is.
  const bool outside = source.clearance.distance[p] >= 0;
  const auto& pairs = source.pairs.of_mesh[m].particles;  // in the order of the active particles
  std::vector<MeshDistance<Real>>& nearby = part.nearby;
  std::size_t& cursor = part.cursor[m];
  std::size_t nearest = 0;
  nearby.clear();
  for (; cursor < pairs.size() && pairs[cursor].cloth == i; ++cursor) {
    if (outside && pairs[cursor].distance - moved > reach_of(source, i)) continue;
    nearby.push_back(distance_to_triangle(*source.shapes.meshes[m], pairs[cursor].feature, x));
    if (nearby.back().size < nearby[nearest].size) nearest = nearby.size() - 1;
  }
  return nearest;
}

/// Rows of one particle with the triangles of one mesh. Whether it is inside a solid is decided by
/// the nearest triangle alone; inside, only the nearest way out counts. Outside, every triangle is
/// kept off from the side on which the particle is, whatever side of a thin solid that is.
/// @return closest points computed
template <class Real>
std::uint64_t add_mesh_rows(const ObjectRowSource<Real>& source, std::size_t m, Index i,
                            RowScratch<Real>& scratch, ObjectRowPart<Real>& part,
                            RowList<Real>& rows) {
  const MeshShape<Real>& mesh = *source.shapes.meshes[m];
  const std::size_t collider = source.shapes.mesh_collider[m];
  const ColliderFrame<Real>& frame = source.shapes.frames[collider];
  const std::size_t nearest = find_nearby(source, m, i, scratch.moved[at_index(i)], part);
  const std::vector<MeshDistance<Real>>& nearby = part.nearby;
  if (nearby.empty()) return 0;
  Real& gap = scratch.gap[at_index(i)];
  gap = std::min(gap, nearby[nearest].distance);
  if (nearby[nearest].distance < 0) {
    note_inside(i, collider, scratch.inside);
    add_inside(source, i, frame.world_direction(nearby[nearest].normal), nearby[nearest].distance,
               collider, scratch.inside, rows);
    return nearby.size();
  }
  for (const MeshDistance<Real>& d : nearby) {
    const Real distance = std::abs(d.distance);
    if (distance > reach_of(source, i)) continue;
    ContactBarrier<Real> barrier{
        frame.world_direction(d.distance < 0 ? (-d.normal).eval() : d.normal), 0, distance};
    const Triangle& t = mesh.triangles[at_index(d.triangle)];
    barrier.top = top_of(source.shapes, m, barrier.normal, {t[0], t[1], t[2]});
    // Where the surface goes on from the border of a triangle, nearer to the particle, what lies
    // beyond carries: a plane at the border would stand in the way of whatever slides over it.
    const bool goes_on =
        std::any_of(nearby.begin(), nearby.end(), [&](const MeshDistance<Real>& other) {
          return std::abs(other.distance) < distance && shares_nearest(mesh, d, other.triangle);
        });
    add_row(source, {i}, {Real(1), 0, 0}, barrier, collider, !goes_on, rows);
  }
  return nearby.size();
}

/// Rows of one particle with planes.
template <class Real>
void add_plane_rows(const ObjectRowSource<Real>& source, Index i, RowList<Real>& rows) {
  const Vec3<Real>& p = source.state.x[at_index(i)];
  for (const ObjectPlane<Real>& plane : source.shapes.planes) {
    const Real distance = plane.normal.dot(p) - plane.offset;
    if (distance > reach_of(source, i)) continue;
    add_row(source, {i}, {Real(1), 0, 0},
            {plane.normal, static_cast<double>(plane.offset), distance}, plane.collider, true,
            rows);
  }
}

/// Row of one particle with a ball or a rod.
template <class Real>
void add_round_row(const ObjectRowSource<Real>& source, Index i, const RoundObject<Real>& rod,
                   RowScratch<Real>& scratch, RowList<Real>& rows) {
  const Vec3<Real>& x = source.state.x[at_index(i)];
  const Vec3<Real>&from = rod.a, &to = rod.b;
  const Real reach = reach_of(source, i);
  const Real far = rod.radius + reach + source.clearance.smallest_gap;
  if ((x - from - (to - from) * closest_on_segment(x, from, to)).squaredNorm() > far * far) return;
  const Vec3d p = in_double(x), a = in_double(from), b = in_double(to);
  const Vec3d q = a + (b - a) * closest_on_segment<double>(p, a, b);
  const Apart side = apart(p, q);
  const Vec3<Real> normal = side.normal.cast<Real>();
  const Real distance = static_cast<Real>(side.distance) - rod.radius;
  if (distance > reach) return;
  if (distance < 0) {
    add_inside(source, i, normal, distance, rod.collider, scratch.inside, rows);
    return;
  }
  const Vec3d n = in_double(normal);
  const double top = std::max(n.dot(a), n.dot(b)) + static_cast<double>(rod.radius);
  add_row(source, {i}, {Real(1), 0, 0}, {normal, top, distance, kept_height(source, i, distance)},
          rod.collider, true, rows);
}

template <class Real>
RowRoom<Real> room_of(const ContactRow<Real>& row) {
  const auto square = [](Real distance) { return distance > 0 ? distance * distance : Real(-1); };
  RowRoom<Real> room;
  for (std::size_t k = 0; k < 3; ++k) room.particle[k] = row.particle[k < row.count ? k : 0];
  room.touch2 = row.responds
                    ? square((row.distance - row.thickness - Real(kTouchSlack)) * Real(kTouchPart))
                    : std::numeric_limits<Real>::infinity();
  room.cross2 = square(row.least_height - row.keep);
  return room;
}

}  // namespace

template <class Real>
bool allow_rows(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                const ObjectMotion<Real>& motion, const ClothState<Real>& state, Real dt,
                const Clearance<Real>& clearance, const NearFeatures<Real>& near,
                Executor* executor, std::vector<Real>& moved, std::vector<Real>& reach) {
  assert(clearance.collected && reach.size() == state.x.size());
  const bool edges_matter = !(shapes.rounds.empty() && shapes.meshes.empty());
  const Real thickness = cloths.thickness;
  std::array<bool, kMostParts> lacks{};
  const auto allow = [&](std::size_t part, std::size_t first, std::size_t last) {
    bool enough = true;
    for (std::size_t i = first; i < last; ++i) {
      moved[i] = (state.x[i] - clearance.x[i]).norm();
      const Real left = clearance.skin[i] - moved[i] - motion.since_pairs;
      const Real step = state.v[i].norm() * dt;
      // An object and what it carries along both go its way.
      enough &= left >= step * Real(1.5) + motion.coming * Real(3);
      Real wanted = (step + motion.coming) * Real(kRowSubsteps);
      if (edges_matter && !motion.any_tracked)
        wanted = std::min(wanted,
                          std::max(thickness * Real(kRowThicknesses), step * Real(kFewSubsteps)));
      wanted = std::max(wanted, thickness / 2);
      // A particle that is clear of everything may go farther without touching.
      if (shapes.meshes.empty() && near.paired[i] && wanted < left)
        wanted = std::max(
            wanted, (analytic_clearance(shapes, state.x[i], left / Real(kFreePart)) - thickness) *
                        Real(kFreePart));
      reach[i] = near.paired[i] ? std::min(left, wanted) : left;
    }
    lacks[part] = !enough;
  };
  const std::size_t count = state.x.size();
  run_parts(executor, count, parts_of(count, kAllowedAtLeast), allow);
  return std::find(lacks.begin(), lacks.end(), true) == lacks.end();
}

template <class Real>
void add_row(const ObjectRowSource<Real>& source, std::initializer_list<Index> particles,
             const std::array<Real, 3>& weights, const ContactBarrier<Real>& barrier,
             std::size_t collider, bool responds, RowList<Real>& rows) {
  assert(particles.size() >= 1 && particles.size() <= 3);
  const ClothState<Real>& state = source.state;
  const ColliderFrame<Real>& frame = source.shapes.frames[collider];
  ContactRow<Real> row;
  Real mobility = 0;
  double least = std::numeric_limits<double>::infinity();
  const Vec3d normal = barrier.normal.template cast<double>();
  for (const Index i : particles) {
    const auto k = row.count++;
    const auto p = at_index(i);
    row.particle[k] = i;
    row.weight[k] = weights[k];
    mobility += weights[k] * weights[k] * state.inverse_mass[p];
    least = std::min(least, normal.dot(state.x[p].template cast<double>()) - barrier.top);
  }
  // What is pinned stops only what moves.
  const bool held = !(mobility > 0);
  if (held && !frame.tracked) return;
  bool any_pinned = false;
  Real lever = 0;
  for (std::size_t k = 0; k < row.count && !held; ++k) {
    const Real inverse_mass = state.inverse_mass[at_index(row.particle[k])];
    row.share[k] = row.weight[k] * inverse_mass / mobility;
    lever = std::max(lever, row.share[k]);
    any_pinned = any_pinned || inverse_mass == 0;
  }
  row.least_height = static_cast<Real>(least);
  row.distance = barrier.distance;
  row.keep = std::max(barrier.keep, source.clearance.smallest_gap);
  row.collider = static_cast<Index>(collider);
  row.responds = responds && !held && !(any_pinned && lever > Real(kMostLever));
  row.cloth = cloth_of(source.cloths, row.particle[0]);
  const ContactDef& settings = settings_of(source.cloths, row);
  row.thickness = static_cast<Real>(settings.thickness);
  row.friction = static_cast<Real>(settings.friction * frame.friction_factor);
  row.normal = barrier.normal;
  row.offset = static_cast<Real>(barrier.top);
  if (frame.tracked) {
    row.mover = static_cast<Index>(rows.moving.size());
    follow(row, barrier.top, frame, mobility, rows);
  }
  rows.all.push_back(row);
}

template <class Real>
void add_particle_rows(const ObjectRowSource<Real>& source, Executor* executor,
                       RowScratch<Real>& scratch, RowList<Real>& rows, Profile& profile) {
  const ObjectShapes<Real>& shapes = source.shapes;
  const std::vector<Index>& near = source.near.particles;
  for (BadStart<Real>& exit : rows.exits) exit.particles = 0;
  scratch.inside.assign(source.state.x.size(), kOutside);
  const auto make = [&](std::size_t first, std::size_t last, ObjectRowPart<Real>& part,
                        RowList<Real>& into) {
    find_cursors(source, first, part);
    for (std::size_t n = first; n < last; ++n) {
      const Index i = near[n];
      add_plane_rows(source, i, into);
      for (const RoundObject<Real>& rod : shapes.rounds)
        add_round_row(source, i, rod, scratch, into);
      part.tests += shapes.planes.size() + shapes.rounds.size();
      for (std::size_t m = 0; m < shapes.meshes.size(); ++m)
        part.tests += add_mesh_rows(source, m, i, scratch, part, into);
    }
  };
  profile[Stage::narrow_phase].work += make_in_parts(executor, near.size(), scratch, rows, make);
}

template <class Real>
Corners<Real> corners_of(const ObjectRowSource<Real>& source, const std::vector<Real>& gap,
                         std::span<const Index> particles) {
  assert(particles.size() == 2 || particles.size() == 3);
  const Vec3Array<Real>& x = source.state.x;
  const std::size_t count = particles.size();
  Corners<Real> corners;
  corners.unseen = source.clearance.smallest_gap;
  Real longest = 0, reach = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = at_index(particles[k]), j = at_index(particles[(k + 1) % count]);
    longest = std::max(longest, (x[i] - x[j]).squaredNorm());
    reach = std::max(reach, source.reach[i]);
    corners.gap = std::min(corners.gap, gap[i] - source.reach[i]);
  }
  corners.reach = reach;
  corners.span = (std::sqrt(longest) + 2 * reach) * Real(count == 2 ? kEdgeSpan : kTriangleSpan);
  return corners;
}

template <class Real>
Real kept_height(const ObjectRowSource<Real>& source, Index particle, Real distance) {
  if (source.objects_move) return 0;
  return std::min(thickness_at(source.cloths, particle) * Real(kKeptPart), distance / 2);
}

template <class Real>
void finish_rows(const ContactCloths<Real>& cloths, std::size_t particles, Executor* executor,
                 ObjectRows<Real>& rows) {
  std::erase_if(rows.exits, [](const BadStart<Real>& exit) { return exit.particles == 0; });
  const std::size_t count = rows.all.size();
  rows.rooms.resize(count);
  run_parts(executor, count, parts_of(count, kMadeAtLeast),
            [&](std::size_t, std::size_t first, std::size_t last) {
              for (std::size_t r = first; r < last; ++r) rows.rooms[r] = room_of(rows.all[r]);
            });
  rows.lone.find(rows.all, rows.rooms, cloths.defs, particles);
  rows.joint.clear();
  for (std::size_t r = 0; r < rows.all.size(); ++r) {
    if (!rows.lone.has(r)) rows.joint.push_back(r);
  }
}

WEFT_INSTANTIATE_FUNCTIONS(allow_rows, add_row, add_particle_rows, corners_of, kept_height,
                           finish_rows)

}  // namespace weft
