#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/contact/guard/spread_pass.h"
#include "core/geometry/quad_box.h"

// Broad phase of cloth against cloth: a tree of patches, and the cull of those that are spread out.

namespace weft {

/// Linear motion of all particles over a stretch of time, each in a ball around its predicted path.
template <class Real>
struct PredictedMotion {
  QuadArray<Real> start, end;  ///< positions at both ends of the stretch [m]
  Real radius = 0;             ///< of the balls [m]
  Real margin = 0;             ///< by which boxes are wider than the balls [m]
};

/// A patch of a grid is at most this many cells wide. Wider: fewer boxes, and more features in
/// those that touch.
inline constexpr int kPatchCells = 2;

/// A bit for each feature of a patch.
struct PatchMarks {
  std::uint32_t vertices = 0, edges = 0, triangles = 0;
};

/// Where the particles of features of one kind stand in the list of their patch.
template <std::size_t Count>
using FeatureCorners = std::vector<std::array<std::uint8_t, Count>>;

/// Hierarchy of axis-aligned boxes over patches of cloths. Its shape is made once, from the mesh;
/// boxes are refitted. Patches of a grid are rectangles of cells; those of other meshes are halved
/// by place. Every particle and edge belongs to one patch, every triangle too.
///
/// Patch cull: where the in-plane part of the deformation gradient of all triangles of a rectangle
/// of the fabric, in one common plane, has a symmetric part with no eigenvalue below lambda, two
/// points of it are at least lambda times as far apart as in the fabric. So what is stretched out
/// enough cannot touch itself, and no pair within it needs a test. The gradient in one plane is
/// linear in time on linear paths and the least eigenvalue concave, so both ends of the stretch are
/// enough, in the same plane. When some particles get other paths, the triangles of the others keep
/// to what was found, and in that plane only the triangles with a changed one are tested again.
/// Where a rectangle around a patch is not stretched out as a whole, single cells of it are looked
/// at anew in every search, so that what joins the patch to one beside it may be.
template <class Real>
class PatchTree {
 public:
  PatchTree() = default;
  explicit PatchTree(const ClothModel<Real>& model);

  /// Fits boxes around the motion and finds the rectangles that cannot touch themselves.
  /// @param cull  whether to look for these at all
  void refit(const PredictedMotion<Real>& motion, bool cull);

  /// The same for a motion that, but for some particles, is the rest of the one before; marks the
  /// patches that have one of these. Boxes and rectangles without them stay as they are.
  /// @param particles  whose motion changed
  /// @param changed    of each particle one number, not 0 if it is among them
  void refit_changed(const PredictedMotion<Real>& motion, const std::vector<Index>& particles,
                     const std::vector<char>& changed);

  /// Forgets which rectangles were not stretched out.
  void forget();

  /// Whether the rectangle around two patches of a grid that adjoin each other, or the same patch,
  /// is stretched out so much that they cannot touch. Asked after refitting, for the same motion.
  bool are_spread(Index p, Index q, const PredictedMotion<Real>& motion);

  /// What stands in a patch.
  struct Patch {
    std::vector<Index> vertices, edges, triangles;  ///< that belong to it
    std::vector<Index> particles;                   ///< of its triangles, ascending
    std::vector<PatchMarks> having;                 ///< of each of these, the features that have it
    FeatureCorners<1> vertex_corners;               ///< of `vertices`
    FeatureCorners<2> edge_corners;                 ///< of `edges`
    FeatureCorners<3> triangle_corners;             ///< of `triangles`
  };
  const Patch& patch(Index p) const { return patches_[at_index(p)]; }
  std::size_t patch_count() const { return patches_.size(); }

  /// Whether a patch has a changed particle.
  bool is_marked(Index p) const { return node_of(p).marked; }
  /// The patches that have one, each once.
  const std::vector<Index>& marked() const { return marked_; }

  /// Like `for_each_near_pair`, but only for pairs with a marked patch. Other pairs need no visit:
  /// features that were apart on their paths stay apart while these go on.
  template <class Visit>
  void for_each_changed_pair(Visit&& visit) const {
    if (!nodes_.empty()) visit_inside<true>(0, visit);
  }

  /// Calls visit(p, q), p <= q, for all patches whose boxes overlap, and each patch with itself,
  /// without those in a rectangle that was found stretched out; in a fixed order.
  template <class Visit>
  void for_each_near_pair(Visit&& visit) const {
    if (!nodes_.empty()) visit_inside<false>(0, visit);
  }

 private:
  /// Rectangle of cells of a grid.
  struct CellRange {
    int row = 0, row_end = 0, column = 0, column_end = 0;
    int cells() const { return (row_end - row) * (column_end - column); }
    bool holds(const CellRange& o) const {
      return row <= o.row && o.row_end <= row_end && column <= o.column &&
             o.column_end <= column_end;
    }
    bool operator==(const CellRange&) const = default;
  };
  /// Two orthonormal directions.
  struct Plane {
    Quad<Real> u, v;
  };
  /// The cells around a patch that are stretched out in its plane.
  struct SpreadCells {
    int row = 0, column = 0;  ///< of the first one
    std::uint64_t bits = 0;   ///< of the cell r rows and c columns farther, bit 8 r + c
    std::uint64_t refit = ~std::uint64_t{0};  ///< when they were found
  };
  struct Node {
    QuadBox<Real> box;
    Index above = kNone;                ///< node, before this one; none for the root
    Index left = kNone, right = kNone;  ///< nodes, behind this one
    Index patch = kNone;                ///< of a leaf
    Index part = kNone;                 ///< cloth; none if there are several below
    Index triangles = 0;                ///< below it
    CellRange cells;                    ///< of a grid
    CellRange spread;                   ///< what is stretched out around it; empty if it is not
    bool marked = false;                ///< it or one below has a changed particle
    std::uint8_t misses = 0;            ///< how often in a row it was not stretched out
    std::uint8_t wait = 0;              ///< so many searches pass before it is tried again
  };

  void build_grid(const ClothModel<Real>& model, Index part);
  Index split_grid(const ClothModel<Real>& model, Index part, const CellRange& cells);
  Index split_mesh(const ClothModel<Real>& model, Index part, std::vector<Index>& list,
                   std::size_t begin, std::size_t end);
  Index add_patch(const ClothModel<Real>& model, Index part, const std::vector<Index>& triangles);
  void give_features(const ClothModel<Real>& model);

  const Node& node_of(Index patch) const { return nodes_[at_index(node_of_[at_index(patch)])]; }
  void give_patches(std::size_t particles);
  void fit_box(Node& node, const PredictedMotion<Real>& motion) const;
  void mark(const std::vector<Index>& particles);
  void fit_marked(Index node, const PredictedMotion<Real>& motion);
  void sum_changed(const std::vector<char>& changed);
  bool has_changed(Index part, const CellRange& cells) const;
  bool is_grid(const Node& node) const {
    return node.part != kNone && parts_[at_index(node.part)].rows > 0;
  }
  CellRange grown(const Node& node) const;
  const SpreadCells& spread_around(Index patch, const PredictedMotion<Real>& motion);
  Real least_spread(const Node& node, Real radius) const;
  void mark_spread(Index node, const PredictedMotion<Real>& motion);
  void renew_spread(Index node, const PredictedMotion<Real>& motion,
                    const std::vector<char>& changed);
  bool find_spread(Index node, const PredictedMotion<Real>& motion);
  bool stays_spread(Index node, const PredictedMotion<Real>& motion,
                    const std::vector<char>& changed) const;
  void give_spread(Index node, const CellRange& cells);
  bool find_plane(const PredictedMotion<Real>& motion, const CellRange& cells, Index part,
                  Plane& plane) const;
  SpreadPass<Real> spread_pass(const QuadArray<Real>& x, const Plane& plane, const CellRange& cells,
                               Index part, Real least) const;
  bool is_spread(const QuadArray<Real>& x, const Plane& plane, const CellRange& cells, Index part,
                 Real least) const;
  bool is_apart(const Node& a, const Node& b) const {
    if (a.part == kNone || a.part != b.part) return false;
    return (a.spread.cells() > 0 && a.spread.holds(b.cells)) ||
           (b.spread.cells() > 0 && b.spread.holds(a.cells));
  }

  template <bool MarkedOnly, class Visit>
  void visit_inside(Index n, Visit&& visit) const {
    const Node& node = nodes_[at_index(n)];
    if (node.spread.cells() > 0 || (MarkedOnly && !node.marked)) return;
    if (node.patch != kNone) {
      visit(node.patch, node.patch);
      return;
    }
    visit_inside<MarkedOnly>(node.left, visit);
    visit_inside<MarkedOnly>(node.right, visit);
    visit_between<MarkedOnly>(node.left, node.right, visit);
  }
  template <bool MarkedOnly, class Visit>
  void visit_between(Index a, Index b, Visit&& visit) const {
    const Node &p = nodes_[at_index(a)], &q = nodes_[at_index(b)];
    if (MarkedOnly && !p.marked && !q.marked) return;
    if (!p.box.overlaps(q.box) || is_apart(p, q)) return;
    if (p.patch != kNone && q.patch != kNone) {
      visit(std::min(p.patch, q.patch), std::max(p.patch, q.patch));
    } else if (q.patch != kNone || (p.patch == kNone && p.triangles >= q.triangles)) {
      visit_between<MarkedOnly>(p.left, b, visit);
      visit_between<MarkedOnly>(p.right, b, visit);
    } else {
      visit_between<MarkedOnly>(a, q.left, visit);
      visit_between<MarkedOnly>(a, q.right, visit);
    }
  }

  std::vector<Node> nodes_;  ///< parents before children; the first is the root
  std::vector<Patch> patches_;
  std::vector<Plane> planes_;  ///< of each node, in which it is stretched out, if found for it
  std::uint64_t refits_ = 0;   ///< how often boxes were fitted
  std::vector<SpreadCells> around_;  ///< of each patch
  std::vector<Index> node_of_;       ///< each patch's
  /// Of each particle, a range of the patches that have it.
  std::vector<Index> patches_begin_, patches_with_;
  std::vector<Index> marked_;  ///< patches
  std::vector<ClothPart<Real>> parts_;
  std::vector<std::vector<Real>> falls_;  ///< of each grid's cells, for SpreadPass
  /// Of each grid, the number of changed particles before a row and a column.
  std::vector<std::vector<int>> changed_sums_;
};

}  // namespace weft
