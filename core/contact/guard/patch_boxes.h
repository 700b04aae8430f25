#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/guard/patch_tree.h"

// Boxes of the features of two patches, compared in vector code.

namespace weft {

/// A patch has at most this many features of a kind: each is a bit of a number.
inline constexpr std::size_t kMostPatchFeatures = 32;

/// Boxes of the features of one kind, component by component: lower x y z, upper x y z [m].
template <class Real>
struct BoxColumns {
  const Real* numbers = nullptr;
  std::size_t count = 0, pitch = 0;  ///< boxes, and numbers a component
};

/// The boxes of a patch. Those of each kind are padded with empty ones.
template <class Real>
struct PatchColumns {
  BoxColumns<Real> vertices, edges, triangles;
  const Real* whole = nullptr;  ///< the box around them all: lower x y z, upper x y z [m]
};

/// Which features of two patches have boxes that overlap: for each of the one a bit for each of the
/// other. Only pairs of which a feature is marked.
struct PatchOverlaps {
  using Bits = std::array<std::uint32_t, kMostPatchFeatures>;
  Bits first_vertices, second_vertices;  ///< of either patch, with the triangles of the other one
  Bits first_edges;                      ///< with the edges of the second patch
};

/// Tests the features of two patches, many at a time: first those of the one with the box around
/// the other, as patches mostly touch with an edge or a corner.
/// @param marked_p, marked_q  pairs without a marked feature are left out
template <class Real>
void overlap_patches(const PatchColumns<Real>& p, const PatchColumns<Real>& q,
                     const PatchMarks& marked_p, const PatchMarks& marked_q,
                     PatchOverlaps& overlaps);

/// Takes out features that share a particle: these always touch.
/// @param p, q  whose features were compared
template <class Real>
void leave_out_incident(const typename PatchTree<Real>::Patch& p,
                        const typename PatchTree<Real>::Patch& q, PatchOverlaps& overlaps);

/// Boxes around the motion of the features of patches, in the order in which the patches list them.
template <class Real>
class PatchBoxes {
 public:
  using Patch = typename PatchTree<Real>::Patch;

  PatchBoxes() = default;
  explicit PatchBoxes(const PatchTree<Real>& tree);

  /// Says that the motion in all patches is another one.
  void forget() { fits_.assign(fits_.size(), 0); }
  /// Says that it is in one.
  void forget(Index patch) { fits_[at_index(patch)] = 0; }
  /// Says that the boxes of a patch are about to be fitted.
  /// @return whether they fitted already
  bool mark_fitted(Index patch) { return std::exchange(fits_[at_index(patch)], 1) != 0; }

  /// Fits the boxes of a patch. Several patches may be fitted at once.
  /// @param patch    its features
  /// @param changed  of each particle one number, not 0 if its motion changed
  void fit(Index p, const Patch& patch, const PredictedMotion<Real>& motion,
           const std::vector<char>& changed);

  /// Which features had a particle with a changed motion when the patch was fitted.
  const PatchMarks& changed(Index p) const { return changed_[at_index(p)]; }

  /// The boxes of a patch, which must fit.
  PatchColumns<Real> columns(Index p, const Patch& patch) const;

 private:
  /// Of the patch that is being fitted, for each of its particles.
  using CornerBoxes = std::array<QuadBox<Real>, kMostPatchFeatures>;
  template <std::size_t CornerCount>
  static std::uint32_t fit_features(const FeatureCorners<CornerCount>& features,
                                    const CornerBoxes& corners, std::uint32_t changed,
                                    std::size_t pitch, Real* numbers);

  std::vector<std::size_t> begin_;  ///< of each patch: its first number
  AlignedVector<Real> numbers_;
  std::vector<char> fits_;
  std::vector<PatchMarks> changed_;
};

extern template class PatchBoxes<float>;
extern template class PatchBoxes<double>;

}  // namespace weft
