// Finds where cloth passes through cloth, and which cloths are hopelessly tangled.

#include "core/contact/guard/guarded_tangles.h"

#include <algorithm>
#include <cassert>

#include "core/contact/guard/constants.h"
#include "core/contact/guard/patch_boxes.h"
#include "core/instantiate.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

bool share_particle(const Edge& edge, const Triangle& t) {
  return std::any_of(edge.begin(), edge.end(),
                     [&](Index i) { return i == t[0] || i == t[1] || i == t[2]; });
}

template <class Real, class Particles>
QuadBox<Real> box_of(const Particles& particles, const QuadArray<Real>& x) {
  QuadBox<Real> box;
  for (const Index i : particles) box.add(x[at_index(i)]);
  return box;
}

/// Looks at the edges of one patch and the triangles of another one.
template <class Real>
void look_through(const GuardedCloths<Real>& cloths, const typename PatchTree<Real>::Patch& first,
                  const typename PatchTree<Real>::Patch& second, const QuadArray<Real>& x,
                  ClothTangles<Real>& tangles) {
  const std::vector<Index>& triangles = second.triangles;
  assert(triangles.size() <= kMostPatchFeatures);
  std::array<QuadBox<Real>, kMostPatchFeatures> boxes;
  QuadBox<Real> all;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    boxes[k] = box_of<Real>(cloths.triangles[at_index(triangles[k])], x);
    all.add(boxes[k].lower);
    all.add(boxes[k].upper);
  }
  for (const Index e : first.edges) {
    const Edge& edge = cloths.edges[at_index(e)];
    const QuadBox<Real> box = box_of<Real>(edge, x);
    if (!box.overlaps(all)) continue;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const Index t = triangles[k];
      if (box.overlaps(boxes[k]) && !share_particle(edge, cloths.triangles[at_index(t)]))
        tangles.look_at(e, t, x);
    }
  }
}

/// Counts crossings for a cloth, which may be a heap then.
template <class Real>
void count_crossings(std::size_t cloth, std::size_t particles, std::size_t count,
                     GuardedTangles<Real>& tangled) {
  tangled.crossings_of[cloth] += count;
  const std::size_t most = std::max(kFewCrossings, particles / kHeapPart);
  if (tangled.is_heap[cloth] || tangled.crossings_of[cloth] <= most) return;
  tangled.is_heap[cloth] = 1;
  ++tangled.heaps;
}

}  // namespace

template <class Real>
void find_tangles(const PatchTree<Real>& tree, const GuardedCloths<Real>& cloths,
                  const std::vector<char>& resting, const QuadArray<Real>& x,
                  const std::vector<Real>& inverse_mass, GuardedTangles<Real>& tangled) {
  assert(resting.size() == tree.patch_count());
  ClothTangles<Real>& tangles = tangled.tangles;
  tangles.clear();
  tangled.is_heap.assign(tangled.is_heap.size(), 0);
  tangled.crossings_of.assign(tangled.crossings_of.size(), 0);
  tangled.heaps = 0;
  std::size_t looked = 0;
  tree.for_each_near_pair([&](Index p, Index q) {
    if (resting[at_index(p)] && resting[at_index(q)]) return;
    const auto &first = tree.patch(p), &second = tree.patch(q);
    if (in_heap(tangled, cloths, first) || in_heap(tangled, cloths, second)) return;
    stop_point(looked++);
    const std::size_t before = tangles.size();
    look_through(cloths, first, second, x, tangles);
    if (p != q) look_through(cloths, second, first, x, tangles);
    if (tangles.size() == before) return;
    for (const auto* patch : {&first, &second}) {
      const auto cloth = at_index(cloth_of(cloths, patch->particles.front()));
      count_crossings(cloth, static_cast<std::size_t>(cloths.particles_of[cloth].count),
                      tangles.size() - before, tangled);
    }
  });
  const auto is_left_out = [&](Index particle) {
    return tangled.is_heap[at_index(cloth_of(cloths, particle))] != 0;
  };
  if (tangled.heaps > 0) {
    tangles.leave_out([&](const TangleCrossing& c) {
      return is_left_out(cloths.edges[at_index(c.edge)][0]) ||
             is_left_out(cloths.triangles[at_index(c.triangle)][0]);
    });
  }
  tangles.decide(x, inverse_mass);
}

template <class Real>
void note_touches(const GuardedPairs<Real>& pairs, const QuadArray<Real>& x,
                  GuardedTangles<Real>& tangled) {
  for (const GuardedPair<Real>& pair : pairs.all) {
    if (pair.open && !tangled.tangles.frees(pair.kind, pair.particle))
      tangled.tangles.note_touch(pair.kind, pair.particle, x);
  }
}

template <class Real>
std::vector<std::array<Index, 2>> tangled_cloths(const GuardedTangles<Real>& tangled,
                                                 const GuardedPairs<Real>& pairs,
                                                 const GuardedCloths<Real>& cloths) {
  std::vector<std::array<Index, 2>> list;
  const auto add = [&](Index i, Index j) {
    const auto [p, q] = std::minmax({cloth_of(cloths, i), cloth_of(cloths, j)});
    list.push_back({p, q});
  };
  for (const TangleCrossing& c : tangled.tangles.crossings())
    add(cloths.edges[at_index(c.edge)][0], cloths.triangles[at_index(c.triangle)][0]);
  for (const GuardedPair<Real>& pair : pairs.all) {
    if (pair.open && !pair.gone) add(pair.particle[0], pair.particle[3]);
  }
  for (std::size_t k = 0; k < tangled.is_heap.size(); ++k) {
    if (tangled.is_heap[k] != 0) list.push_back({static_cast<Index>(k), static_cast<Index>(k)});
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

WEFT_INSTANTIATE_FUNCTIONS(find_tangles, note_touches, tangled_cloths)

}  // namespace weft
