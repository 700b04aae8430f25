#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/guard/guarded_cloths.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/patch_tree.h"
#include "core/contact/tangles/cloth_tangles.h"
#include "core/math/quad.h"
#include "core/types.h"

// Cloth that starts through cloth: the guard promises nothing about it until it is apart.

namespace weft {

/// What crosses since the start, and cloths of which so much does that it is hopeless.
template <class Real>
struct GuardedTangles {
  ClothTangles<Real> tangles;
  bool unseen = true;                     ///< nothing has been searched for crossings yet
  std::vector<std::size_t> crossings_of;  ///< each cloth, until it is a heap
  /// Of each cloth, whether so much of it crosses that it is not examined: it passes through all
  /// cloth until its springs have spread it out, and is drawn apart then.
  std::vector<char> is_heap;
  std::size_t heaps = 0;  ///< how many these are

  /// Crossings and heaps, about which nothing is promised.
  std::size_t open() const { return tangles.size() + heaps; }
};

/// Searches for edges that pass through triangles now.
/// @param tree     fitted
/// @param resting  1 for each patch of a cloth that sleeps
/// @param x        positions [m]
template <class Real>
void find_tangles(const PatchTree<Real>& tree, const GuardedCloths<Real>& cloths,
                  const std::vector<char>& resting, const QuadArray<Real>& x,
                  const std::vector<Real>& inverse_mass, GuardedTangles<Real>& tangled);

/// Whether a patch belongs to a heap.
template <class Real>
bool in_heap(const GuardedTangles<Real>& tangled, const GuardedCloths<Real>& cloths,
             const typename PatchTree<Real>::Patch& patch) {
  if (tangled.heaps == 0) return false;
  return tangled.is_heap[at_index(cloth_of(cloths, patch.particles.front()))] != 0;
}

/// Pairs that touch do not cross, and nothing tells their sides: they are drawn apart too.
template <class Real>
void note_touches(const GuardedPairs<Real>& pairs, const QuadArray<Real>& x,
                  GuardedTangles<Real>& tangled);

/// The cloths, two by two and each two once, that started through each other or themselves and are
/// not apart yet. Allocates.
template <class Real>
std::vector<std::array<Index, 2>> tangled_cloths(const GuardedTangles<Real>& tangled,
                                                 const GuardedPairs<Real>& pairs,
                                                 const GuardedCloths<Real>& cloths);

}  // namespace weft
