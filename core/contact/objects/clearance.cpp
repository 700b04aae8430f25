// Determines which particles are near objects, and for how long that is known.

#include "core/contact/objects/clearance.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/corners.h"
#include "core/contact/parts.h"
#include "core/contact/smallest_gap.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// For each particle, how far the points of its edges and triangles may be from it [m].
template <class Real>
void measure_spans(const std::vector<Edge>& edges, const Vec3Array<Real>& x,
                   std::vector<Real>& span) {
  span.assign(x.size(), Real(0));
  for (const Edge& e : edges) {
    const auto i = at_index(e[0]), j = at_index(e[1]);
    const Real own = Real(kTriangleSpan) * (x[i] - x[j]).norm();
    span[i] = std::max(span[i], own);
    span[j] = std::max(span[j], own);
  }
}

/// How far a particle of a velocity [m/s] should be allowed to move before the next collection [m].
template <class Real>
Real wanted_skin(const ObjectMotion<Real>& motion, Real thickness, Real widest, const Vec3<Real>& v,
                 Real dt) {
  const Real speed = v.norm() + motion.surface_speed;
  const Real most = std::max(widest, speed * dt * Real(kSkinSubsteps));
  return std::max(thickness * 2, std::min(speed * motion.tick_seconds * Real(kSkinTicks), most));
}

}  // namespace

template <class Real>
void measure_clearance(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                       const ObjectMotion<Real>& motion, const ClothState<Real>& state, Real dt,
                       Executor* executor, Clearance<Real>& clearance, Profile& profile) {
  assert(dt > 0 && state.v.size() == state.x.size());
  const std::size_t n = state.x.size();
  Clearance<Real>& c = clearance;
  c.smallest_gap = smallest_gap_at(state.x);
  const bool known = c.collected && c.distance.size() == n;
  if (!known) {
    c.distance.assign(n, Real(-1));
    c.near.assign(n, 0);
    c.has_pairs.assign(n, 0);
    c.collections = 0;
  }
  c.skin.resize(n);
  measure_spans(cloths.patches.edges, state.x, c.span);
  std::array<std::uint64_t, kContactParts> tests{};
  run_parts(executor, n, kContactParts, [&](std::size_t part, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!c.resting.empty() && c.resting[i]) {
        c.distance[i] = Real(kOutOfReach);
        c.skin[i] = 0;
        continue;
      }
      c.skin[i] = wanted_skin(motion, cloths.thickness, shapes.widest_skin, state.v[i], dt);
      const Real needed = cloths.thickness + c.span[i] + c.skin[i];
      if (known) c.distance[i] -= (state.x[i] - c.x[i]).norm() + motion.since_pairs;
      if (c.distance[i] > needed) continue;
      // A particle that was near before had its clearance measured by its pairs. Those without
      // pairs are measured now and then, in turns, to see whether they have left.
      const bool turn = (c.collections + i) % kTurns == 0;
      if (known && c.near[i] && (c.has_pairs[i] || !turn)) continue;
      const Real horizon = needed + static_cast<Real>(kClearanceHorizon);
      // One that was clear of everything is still outside, and a bound is cheaper than a distance.
      c.distance[i] = c.distance[i] > 0 ? least_clearance(shapes, state.x[i], horizon)
                                        : clearance_of(shapes, state.x[i], horizon);
      ++tests[part];
    }
  });
  for (const std::uint64_t count : tests) profile[Stage::broad_phase].work += count;
  ++c.collections;
}

template <class Real>
void mark_near(const ContactCloths<Real>& cloths, Clearance<Real>& clearance,
               NearFeatures<Real>& near) {
  Clearance<Real>& c = clearance;
  const ClothPatches& patches = cloths.patches;
  const std::size_t n = c.distance.size();
  assert(c.span.size() == n && c.skin.size() == n && c.near.size() == n);
  for (std::size_t i = 0; i < n; ++i)
    c.near[i] = c.distance[i] <= cloths.thickness + c.span[i] + c.skin[i];
  near.active = c.near;
  near.place.resize(n);
  near.edges.clear();
  near.triangles.clear();
  near.particles.clear();
  near.patches.clear();
  const auto is_near = [&](Index i) { return c.near[at_index(i)] != 0; };
  const auto number = [](const auto& list) { return static_cast<Index>(list.size()); };
  for (const Edge& ends : patches.edges) {
    if (is_near(ends[0]) || is_near(ends[1]))
      near.active[at_index(ends[0])] = near.active[at_index(ends[1])] = 1;
  }
  for (std::size_t p = 0; p < patches.list.size(); ++p) {
    const ClothPatch& patch = patches.list[p];
    NearPatch found{
        p, {number(near.particles), 0}, {number(near.edges), 0}, {number(near.triangles), 0}};
    for (Index k = patch.particles.first; k < patch.particles.end(); ++k) {
      const Index i = patches.particles[at_index(k)];
      if (!near.active[at_index(i)]) continue;
      near.place[at_index(i)] = number(near.particles);
      near.particles.push_back(i);
    }
    for (Index e = patch.edges.first; e < patch.edges.end(); ++e) {
      const Edge& ends = patches.edges[at_index(e)];
      if (is_near(ends[0]) || is_near(ends[1])) near.edges.push_back(e);
    }
    for (Index t = patch.triangles.first; t < patch.triangles.end(); ++t) {
      const Triangle& corners = patches.triangles[at_index(t)];
      if (std::any_of(corners.begin(), corners.end(), is_near)) near.triangles.push_back(t);
    }
    found.particles.count = number(near.particles) - found.particles.first;
    found.edges.count = number(near.edges) - found.edges.first;
    found.triangles.count = number(near.triangles) - found.triangles.first;
    if (found.particles.count + found.edges.count + found.triangles.count > 0)
      near.patches.push_back(found);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!near.active[i]) c.skin[i] = c.distance[i] - cloths.thickness - c.span[i];
  }
}

template <class Real>
bool renew_clearance(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                     const ClothState<Real>& state, std::size_t i, Real dt,
                     Clearance<Real>& clearance, std::vector<Real>& reach) {
  assert(i < reach.size() && clearance.collected);
  Clearance<Real>& c = clearance;
  const auto for_joined = [&](auto&& visit) {
    for (const auto& neighbour : cloths.patches.neighbours.of(i)) {
      const auto j = at_index(neighbour.particle);
      visit(j, Real(kTriangleSpan) * (state.x[i] - state.x[j]).norm());
    }
  };
  Real longest = 0;
  for_joined([&](std::size_t, Real span) { longest = std::max(longest, span); });
  const Real needed = cloths.thickness + longest + state.v[i].norm() * dt * Real(kSkinSubsteps);
  const Real clear =
      least_clearance(shapes, state.x[i], needed + static_cast<Real>(kClearanceHorizon));
  if (!(clear > needed)) return false;
  c.distance[i] = clear;
  c.span[i] = longest;
  c.skin[i] = reach[i] = clear - cloths.thickness - longest;
  c.x[i] = state.x[i];
  // Edges may have grown since the other end was measured.
  for_joined([&](std::size_t j, Real span) {
    const Real growth = span - c.span[j];
    if (!(growth > 0)) return;
    c.span[j] = span;
    c.skin[j] = std::max(Real(0), c.skin[j] - growth);
    reach[j] = std::max(Real(0), reach[j] - growth);
  });
  return true;
}

template <class Real>
void take_to_own(const ObjectShapes<Real>& shapes, const Vec3Array<Real>& x,
                 NearFeatures<Real>& near) {
  near.x_own.resize(shapes.meshes.size());
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m) {
    const ColliderFrame<Real>& frame = shapes.mesh_frame(m);
    if (!frame.displaced) continue;
    near.x_own[m].resize(x.size());
    for (const Index i : near.particles) {
      const auto p = at_index(i);
      near.x_own[m][p] = frame.own(x[p]);
    }
  }
}

WEFT_INSTANTIATE_FUNCTIONS(measure_clearance, mark_near, renew_clearance, take_to_own)

}  // namespace weft
