#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/guard/guarded_cloths.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/guarded_tangles.h"
#include "core/contact/guard/pair_separation.h"
#include "core/contact/guard/patch_boxes.h"
#include "core/contact/guard/patch_tree.h"
#include "core/executor.h"
#include "core/profile.h"

// The search for pairs of features that could meet while all particles stay near their paths.

namespace weft {

/// What one part of a search needs for itself, and what it found.
template <class Real>
struct PairSearch {
  ColumnsByKind<Real> columns;  ///< of each kind, to be separated together
  PatchOverlaps overlaps;       ///< of the patches that are being tested
  std::vector<GuardedPair<Real>> found;
  std::uint64_t tests = 0;
};

/// Patches of all cloths, and which of them are near each other.
template <class Real>
struct PatchSearch {
  PatchTree<Real> tree;
  PatchBoxes<Real> boxes;
  PredictedMotion<Real> motion;               ///< along the paths, less the common motion
  std::vector<char> changed;                  ///< 1 for each particle with a new path
  std::vector<std::pair<Index, Index>> near;  ///< patches whose features are to be tested
  std::vector<Index> to_fit;                  ///< patches among these whose boxes do not fit
  std::vector<PairSearch<Real>> parts;
};

template <class Real>
PatchSearch<Real> patch_search(const ClothModel<Real>& model);

/// Forgets what a search that was ended from outside has found, and what earlier ones did.
template <class Real>
void forget_found(PatchSearch<Real>& search);

/// Lists the patches that are near each other and not stretched out together. The tree must be
/// fitted to `search.motion`.
template <class Real>
void find_near_patches(PatchSearch<Real>& search);

/// Fits the tree to particles with new paths, and lists the patches that are near one with these.
template <class Real>
void find_near_patches_of(const std::vector<Index>& particles, PatchSearch<Real>& search);

/// What a search leaves out.
template <class Real>
struct LeftOut {
  const std::vector<char>& resting;  ///< 1 for each patch of a cloth that sleeps
  const GuardedTangles<Real>& tangled;
  bool all;  ///< pairs without a new path are not left out
};

/// Tests the features of the patches that are near each other, in parts that do not depend on each
/// other, and adds what they find to the pairs, in their order.
template <class Real>
void test_near_patches(PatchSearch<Real>& search, const GuardedCloths<Real>& cloths,
                       const LeftOut<Real>& left_out, Executor* executor, GuardedPairs<Real>& pairs,
                       Profile& profile);

}  // namespace weft
