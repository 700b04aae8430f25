// Finds rectangles of the fabric that are stretched out so much that they cannot touch themselves,
// and after some particles changed their motion those that still are.

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/contact/guard/patch_tree.h"
#include "core/contact/guard/spread_pass.h"

namespace weft {
namespace {

/// Rounding of the cull's test, relative.
constexpr double kCullSlack = 1e-3;

}  // namespace

template <class Real>
void PatchTree<Real>::sum_changed(const std::vector<char>& changed) {
  changed_sums_.resize(parts_.size());
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const ClothPart<Real>& part = parts_[p];
    std::vector<int>& sums = changed_sums_[p];
    sums.clear();
    if (part.rows * part.columns != part.particles.count) continue;  // no whole grid
    const auto width = static_cast<std::size_t>(part.columns) + 1;
    sums.assign((static_cast<std::size_t>(part.rows) + 1) * width, 0);
    auto i = static_cast<std::size_t>(part.particles.first);
    for (std::size_t at = width; at < sums.size(); at += width) {
      for (std::size_t c = 1; c < width; ++c, ++i)
        sums[at + c] = sums[at + c - 1] + sums[at - width + c] - sums[at - width + c - 1] +
                       (changed[i] != 0 ? 1 : 0);
    }
  }
}

/// Whether a particle of these cells changed its motion, or may have.
template <class Real>
bool PatchTree<Real>::has_changed(Index p, const CellRange& cells) const {
  const std::vector<int>& sums = changed_sums_[static_cast<std::size_t>(p)];
  if (sums.empty()) return true;
  const int width = parts_[static_cast<std::size_t>(p)].columns + 1;
  const auto before = [&](int row, int column) {
    return sums[static_cast<std::size_t>(row * width + column)];
  };
  const int row_end = cells.row_end + 1, column_end = cells.column_end + 1;
  return before(row_end, column_end) - before(cells.row, column_end) -
             before(row_end, cells.column) + before(cells.row, cells.column) !=
         0;
}

/// The rectangle of a node, grown by the width of a patch, so that it covers the patches that
/// adjoin the node.
template <class Real>
typename PatchTree<Real>::CellRange PatchTree<Real>::grown(const Node& node) const {
  const ClothPart<Real>& part = parts_[static_cast<std::size_t>(node.part)];
  return {std::max(node.cells.row - kPatchCells, 0),
          std::min(node.cells.row_end + kPatchCells, part.rows - 1),
          std::max(node.cells.column - kPatchCells, 0),
          std::min(node.cells.column_end + kPatchCells, part.columns - 1)};
}

/// Least eigenvalue that keeps balls of a radius [m] apart, if their features share no particle:
/// these are at least the height of a triangle apart in the fabric.
template <class Real>
Real PatchTree<Real>::least_spread(const Node& node, Real radius) const {
  const ClothPart<Real>& part = parts_[static_cast<std::size_t>(node.part)];
  const Real nearest =
      part.cell_u * part.cell_v / std::sqrt(part.cell_u * part.cell_u + part.cell_v * part.cell_v);
  return 2 * radius / nearest * Real(1 + kCullSlack) + Real(kCullSlack);
}

/// Whether the grown rectangle of a node of a grid is stretched out in one plane; if so, the node
/// keeps the plane.
template <class Real>
bool PatchTree<Real>::find_spread(Node& node, const PredictedMotion<Real>& motion) const {
  const Real least = least_spread(node, motion.radius);
  const CellRange cells = grown(node);
  return least < 1 && find_plane(motion, cells, node.part, node.plane) &&
         is_spread(motion.start, node.plane, cells, node.part, least) &&
         is_spread(motion.end, node.plane, cells, node.part, least);
}

/// Tries the rectangle of a node, and else those of its children.
template <class Real>
void PatchTree<Real>::mark_spread(Index n, const PredictedMotion<Real>& motion) {
  Node& node = nodes_[static_cast<std::size_t>(n)];
  if (is_grid(node) && find_spread(node, motion)) {
    give_spread(n, grown(node));
    return;
  }
  node.spread = {};
  if (node.patch != kNone) return;
  mark_spread(node.left, motion);
  mark_spread(node.right, motion);
}

/// Looks again at rectangles that were stretched out and have a changed particle. The triangles of
/// the others go on as before, so that in the same plane only those of changed ones are tested.
/// What was not stretched out is not tried before all is refitted.
template <class Real>
void PatchTree<Real>::renew_spread(Index n, const PredictedMotion<Real>& motion,
                                   const std::vector<char>& changed) {
  assert(motion.start.size() == changed.size() && motion.end.size() == changed.size());
  Node& node = nodes_[static_cast<std::size_t>(n)];
  if (is_grid(node)) {
    const CellRange cells = grown(node);
    if (!has_changed(node.part, cells)) return;
    if (node.spread.cells() > 0) {
      if (stays_spread(node, motion, changed)) return;
      mark_spread(n, motion);
      return;
    }
  }
  if (node.patch != kNone) return;
  renew_spread(node.left, motion, changed);
  renew_spread(node.right, motion, changed);
}

/// Whether the triangles of changed particles are stretched out in the plane of the others. Each
/// has a straight path from the motion's start to its end, as the old ones have.
template <class Real>
bool PatchTree<Real>::stays_spread(const Node& node, const PredictedMotion<Real>& motion,
                                   const std::vector<char>& changed) const {
  const Real least = least_spread(node, motion.radius);
  const ClothPart<Real>& part = parts_[static_cast<std::size_t>(node.part)];
  const auto has = [&](int r, int c) {
    return changed[static_cast<std::size_t>(part.particles.first + r * part.columns + c)] != 0;
  };
  for (int r = node.spread.row; r < node.spread.row_end; ++r) {
    if (!has_changed(node.part, {r, r + 1, node.spread.column, node.spread.column_end})) continue;
    for (int c = node.spread.column; c < node.spread.column_end; ++c) {
      if (!has(r, c) && !has(r, c + 1) && !has(r + 1, c) && !has(r + 1, c + 1)) continue;
      const CellRange cell = {r, r + 1, c, c + 1};
      if (!is_spread(motion.start, node.plane, cell, node.part, least) ||
          !is_spread(motion.end, node.plane, cell, node.part, least))
        return false;
    }
  }
  return true;
}

template <class Real>
void PatchTree<Real>::give_spread(Index n, const CellRange& cells) {
  Node& node = nodes_[static_cast<std::size_t>(n)];
  node.spread = cells;
  if (node.patch != kNone) return;
  give_spread(node.left, cells);
  give_spread(node.right, cells);
}

/// The plane in which a rectangle lies on the whole during the motion, by the mean of its rows and
/// columns: two directions that stand alike to both.
/// @return whether there is one
template <class Real>
bool PatchTree<Real>::find_plane(const PredictedMotion<Real>& motion, const CellRange& cells,
                                 Index p, Plane& plane) const {
  const ClothPart<Real>& part = parts_[static_cast<std::size_t>(p)];
  const auto at = [&](int r, int c) {
    return static_cast<std::size_t>(part.particles.first + r * part.columns + c);
  };
  Quad<Real> u, v;
  for (const QuadArray<Real>* x : {&motion.start, &motion.end}) {
    for (int r = cells.row; r <= cells.row_end; ++r)
      u += (*x)[at(r, cells.column_end)] - (*x)[at(r, cells.column)];
    for (int c = cells.column; c <= cells.column_end; ++c)
      v += (*x)[at(cells.row_end, c)] - (*x)[at(cells.row, c)];
  }
  const auto scale = [](Quad<Real>& q, Real length) {
    const Real size = std::sqrt(dot(q, q));
    q = q * (length / size);
    return size;
  };
  scale(u, 1);
  scale(v, 1);
  Quad<Real> sum = u + v, difference = u - v;
  const Real half = std::sqrt(Real(0.5));
  if (!(scale(sum, half) > Real(0.1)) || !(scale(difference, half) > Real(0.1))) return false;
  plane = {sum + difference, sum - difference};
  return true;
}

/// Whether the least eigenvalue of the symmetric part of the gradient in a plane is above `least`
/// all over a rectangle.
template <class Real>
bool PatchTree<Real>::is_spread(const QuadArray<Real>& x, const Plane& plane,
                                const CellRange& cells, Index p, Real least) const {
  const ClothPart<Real>& part = parts_[static_cast<std::size_t>(p)];
  SpreadPass<Real> pass;
  pass.particles = part.columns;
  pass.cells = part.columns - 1;
  pass.x = x.data() + part.particles.first + cells.row * pass.particles + cells.column;
  pass.falls = falls_[static_cast<std::size_t>(p)].data() + cells.row * pass.cells + cells.column;
  pass.rows = cells.row_end - cells.row;
  pass.columns = cells.column_end - cells.column;
  const Real per_u = Real(1) / part.cell_u, per_v = Real(1) / part.cell_v;
  for (int k = 0; k < 3; ++k)
    pass.axes[static_cast<std::size_t>(k)] = {plane.u[k] * per_u, plane.v[k] * per_u,
                                              plane.u[k] * per_v, plane.v[k] * per_v};
  pass.least = least;
  return weft::is_spread(pass);
}

#define WEFT_INSTANTIATE(Real)                                                                     \
  template void PatchTree<Real>::sum_changed(const std::vector<char>&);                            \
  template bool PatchTree<Real>::has_changed(Index, const CellRange&) const;                       \
  template typename PatchTree<Real>::CellRange PatchTree<Real>::grown(const Node&) const;          \
  template Real PatchTree<Real>::least_spread(const Node&, Real) const;                            \
  template void PatchTree<Real>::mark_spread(Index, const PredictedMotion<Real>&);                 \
  template void PatchTree<Real>::renew_spread(Index, const PredictedMotion<Real>&,                 \
                                              const std::vector<char>&);                           \
  template bool PatchTree<Real>::find_spread(Node&, const PredictedMotion<Real>&) const;           \
  template bool PatchTree<Real>::stays_spread(const Node&, const PredictedMotion<Real>&,           \
                                              const std::vector<char>&) const;                     \
  template void PatchTree<Real>::give_spread(Index, const CellRange&);                             \
  template bool PatchTree<Real>::find_plane(const PredictedMotion<Real>&, const CellRange&, Index, \
                                            Plane&) const;                                         \
  template bool PatchTree<Real>::is_spread(const QuadArray<Real>&, const Plane&, const CellRange&, \
                                           Index, Real) const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
