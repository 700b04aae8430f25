// Makes the rows of edges and triangles of the cloth with balls and rods.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/contact/constants.h"
#include "core/contact/objects/apart.h"
#include "core/contact/objects/bad_starts.h"
#include "core/contact/objects/constants.h"
#include "core/contact/objects/corners.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/objects/row_parts.h"
#include "core/geometry/distance.h"
#include "core/instantiate.h"

namespace weft {
namespace {

bool between_ends(double s) {
  return s > kEdgeEnd && s < 1 - kEdgeEnd;
}

/// The smallest of the corners' numbers.
template <class Real, class Feature>
Real nearest(const std::vector<Real>& numbers, const Feature& corners) {
  Real least = numbers[at_index(corners[0])];
  for (const Index i : corners) least = std::min(least, numbers[at_index(i)]);
  return least;
}

/// Squared distance of a point of a feature from its nearest corner, at most, even when pushed
/// [m^2]. Computed without a root: (a + b)^2 <= 2 a^2 + 2 b^2.
template <class Real>
Real span2_of(const ObjectRowSource<Real>& source, std::span<const Index> corners) {
  const Vec3Array<Real>& x = source.state.x;
  const std::size_t count = corners.size();
  const Real part = static_cast<Real>(count == 2 ? kEdgeSpan : kTriangleSpan);
  Real longest2 = 0, reach = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = at_index(corners[k]), j = at_index(corners[(k + 1) % count]);
    longest2 = std::max(longest2, (x[i] - x[j]).squaredNorm());
    reach = std::max(reach, source.reach[i]);
  }
  reach += source.cloths.thickness * Real(kRoomForPush);
  const Real both2 = longest2 + 4 * reach * reach;
  return part * part * 2 * both2 * static_cast<Real>(kSurely);
}

/// That of all near features of a kind.
/// @param features  of the cloth
template <class Real, class Feature>
void measure_spans(const ObjectRowSource<Real>& source, Executor* executor,
                   const std::vector<Feature>& features, const std::vector<Index>& near,
                   std::vector<Real>& spans2) {
  spans2.resize(near.size());
  const auto measure = [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      spans2[n] = span2_of<Real>(source, features[at_index(near[n])]);
  };
  run_parts(executor, near.size(), parts_of(near.size(), kMadeAtLeast), measure);
}

/// Whether corners alone keep off a round object: the cheap form of Corners::clear.
/// @param least  distance that they keep from its core [m]
/// @param most   that a point must be from there to be off [m]
template <class Real>
bool is_clear(Real span2, Real least, Real most) {
  return least > 0 && least * least - span2 > most * most;
}

/// Distance from the core of a round object at which a cloth lies on it [m]. Whether particles
/// alone carry the cloth is decided by it, not by where they are: what edges have lifted would be
/// carried by its particles, fall back on its edges, and so gain energy.
template <class Real>
Real height_on(const RoundObject<Real>& rod, const ObjectRowSource<Real>& source, Index particle) {
  return rod.radius + thickness_at(source.cloths, particle);
}

/// Distance of each active particle from the core of a round object while the rows hold: a particle
/// within reach of the object is kept over a plane.
template <class Real>
void measure_cores(const ObjectRowSource<Real>& source, const RoundObject<Real>& rod,
                   Executor* executor, RowScratch<Real>& scratch) {
  const ClothState<Real>& state = source.state;
  const Vec3<Real>&a = rod.a, &b = rod.b;
  const Real radius = rod.radius;
  const Real rounding = radius * std::numeric_limits<Real>::epsilon() * Real(kCoreRoundings);
  scratch.least_core.resize(state.x.size());
  const std::vector<Index>& near = source.near.particles;
  const auto measure = [&](Index k) {
    const auto i = at_index(k);
    Real& least = scratch.least_core[i];
    const Vec3<Real> from = state.x[i] - a;
    const Real core = (from - (b - a) * closest_on_segment(state.x[i], a, b)).norm();
    least = core - source.reach[i] - source.cloths.thickness * Real(kRoomForPush);
    if (state.inverse_mass[i] > 0 && core > radius)
      least = std::max(
          least, radius + kept_height(source, k, core - radius) - source.clearance.smallest_gap);
    least -= rounding;
  };
  run_parts(executor, near.size(), parts_of(near.size(), kMadeAtLeast),
            [&](std::size_t, std::size_t first, std::size_t last) {
              for (std::size_t n = first; n < last; ++n) measure(near[n]);
            });
}

/// Adds the rows of near edges from number `first` to before `last`.
template <class Real>
void add_edges_on(const RoundObject<Real>& rod, const ObjectRowSource<Real>& source,
                  std::size_t first, std::size_t last, const RowScratch<Real>& scratch,
                  RowList<Real>& rows) {
  const Vec3d base = in_double(rod.a), tip = in_double(rod.b);
  const Real most = rod.radius + source.clearance.smallest_gap;
  const Real push = source.cloths.thickness * Real(kRoomForPush);
  for (std::size_t n = first; n < last; ++n) {
    const Edge& e = source.cloths.patches.edges[at_index(source.near.edges[n])];
    const Real least = nearest(scratch.least_core, e);
    if (is_clear(scratch.edge_spans2[n], least, most)) continue;
    const Corners<Real> ends = corners_of<Real>(source, scratch.gap, e);
    if (ends.pushed(kEdgeSpan, push).clear(least, rod.radius)) continue;
    if (is_inside(e[0], rod.collider, scratch.inside) ||
        is_inside(e[1], rod.collider, scratch.inside))
      continue;
    const Vec3d from = in_double(source.state.x[at_index(e[0])]),
                to = in_double(source.state.x[at_index(e[1])]);
    const SegmentPoints<double> c = closest_of_segments<double>(from, to, base, tip);
    const Apart side = apart(c.p, c.q);
    const Real distance = static_cast<Real>(side.distance) - rod.radius;
    if (distance > source.cloths.thickness + ends.reach) continue;
    ContactBarrier<Real> barrier{side.normal.cast<Real>(), 0, distance};
    const Vec3d normal = in_double(barrier.normal);
    barrier.top = std::max(normal.dot(base), normal.dot(tip)) + static_cast<double>(rod.radius);
    const bool carried =
        ends.as_lying(kEdgeSpan, Real(0)).clear(height_on(rod, source, e[0]), rod.radius);
    const Real s = static_cast<Real>(c.s);
    add_row(source, {e[0], e[1]}, {Real(1) - s, s, 0}, barrier, rod.collider,
            !carried && between_ends(c.s), rows);
  }
}

/// Adds the row of a triangle with the ball about the end of a rod.
/// @param reach  of the triangle while the rows hold [m]
template <class Real>
void add_triangle_row(const ObjectRowSource<Real>& source, const Triangle& t, Real reach,
                      const RoundObject<Real>& rod, const Vec3<Real>& centre, bool responds,
                      RowList<Real>& rows) {
  const auto at = [&](std::size_t n) { return in_double(source.state.x[at_index(t[n])]); };
  const Vec3d q = in_double(centre);
  const TrianglePoint<double> c = closest_on_triangle<double>(q, at(0), at(1), at(2));
  const Apart side = apart(c.point, q);
  const Real distance = static_cast<Real>(side.distance) - rod.radius;
  if (distance > source.cloths.thickness + reach) return;
  ContactBarrier<Real> barrier{side.normal.cast<Real>(), 0, distance};
  barrier.top = in_double(barrier.normal).dot(q) + static_cast<double>(rod.radius);
  std::array<Real, 3> weights;
  for (std::size_t n = 0; n < 3; ++n) weights[n] = static_cast<Real>(c.barycentric[n]);
  add_row(source, {t[0], t[1], t[2]}, weights, barrier, rod.collider, responds && c.feature == 0,
          rows);
}

/// Adds the rows of the centre of a ball, or of both ends of a rod, with the inside of near
/// triangles from number `first` to before `last`. @return closest points computed
template <class Real>
std::uint64_t add_triangles_on(const RoundObject<Real>& rod, const ObjectRowSource<Real>& source,
                               std::size_t first, std::size_t last, const RowScratch<Real>& scratch,
                               RowList<Real>& rows) {
  std::uint64_t tests = 0;
  const Real most = rod.radius + source.clearance.smallest_gap;
  const Real push = source.cloths.thickness * Real(kRoomForPush);
  for (std::size_t n = first; n < last; ++n) {
    const Triangle& t = source.cloths.patches.triangles[at_index(source.near.triangles[n])];
    const Real least = nearest(scratch.least_core, t);
    if (is_clear(scratch.triangle_spans2[n], least, most)) continue;
    const Corners<Real> corners = corners_of<Real>(source, scratch.gap, t);
    if (corners.pushed(kTriangleSpan, push).clear(least, rod.radius)) continue;
    const auto is_barred = [&](Index i) { return is_inside(i, rod.collider, scratch.inside); };
    if (std::any_of(t.begin(), t.end(), is_barred)) continue;
    const bool responds =
        !corners.as_lying(kTriangleSpan, Real(0)).clear(height_on(rod, source, t[0]), rod.radius);
    const auto add = [&](const Vec3<Real>& centre) {
      ++tests;
      add_triangle_row(source, t, corners.reach, rod, centre, responds, rows);
    };
    add(rod.a);
    if (!rod.is_ball) add(rod.b);
  }
  return tests;
}

}  // namespace

template <class Real>
void add_features_on_rounds(const ObjectRowSource<Real>& source, Executor* executor,
                            RowScratch<Real>& scratch, RowList<Real>& rows, Profile& profile) {
  const ObjectShapes<Real>& shapes = source.shapes;
  if (shapes.rounds.empty()) return;
  assert(scratch.inside.size() == source.state.x.size() && "rows of particles come first");
  const ClothPatches& patches = source.cloths.patches;
  const NearFeatures<Real>& near = source.near;
  measure_spans(source, executor, patches.edges, near.edges, scratch.edge_spans2);
  measure_spans(source, executor, patches.triangles, near.triangles, scratch.triangle_spans2);
  std::uint64_t tests = 0;
  for (const RoundObject<Real>& rod : shapes.rounds) {
    measure_cores(source, rod, executor, scratch);
    make_in_parts(
        executor, near.edges.size(), scratch, rows,
        [&](std::size_t first, std::size_t last, ObjectRowPart<Real>&, RowList<Real>& into) {
          add_edges_on(rod, source, first, last, scratch, into);
        });
    tests += make_in_parts(
        executor, near.triangles.size(), scratch, rows,
        [&](std::size_t first, std::size_t last, ObjectRowPart<Real>& part, RowList<Real>& into) {
          part.tests = add_triangles_on(rod, source, first, last, scratch, into);
        });
  }
  profile[Stage::narrow_phase].work += tests;
}

WEFT_INSTANTIATE_FUNCTIONS(add_features_on_rounds)

}  // namespace weft
