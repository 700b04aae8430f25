// Finds rectangles of the fabric that are stretched out so much that they cannot touch themselves,
// after some particles changed their motion those that still are, and patches that are stretched
// out together with one beside them.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/contact/guard/patch_tree.h"
#include "core/contact/guard/spread_pass.h"

namespace weft {
namespace {

/// Rounding of the cull's test, relative.
constexpr double kCullSlack = 1e-3;

/// A rectangle that is not stretched out is tried again after at most so many searches. More: the
/// rectangles that are found stay small for longer. Fewer: more are tried in vain.
constexpr std::uint8_t kMostWaits = 7;

static_assert(3 * kPatchCells <= kMostSpreadCells, "a patch with those around it");

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
    auto i = at_index(part.particles.first);
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
  const std::vector<int>& sums = changed_sums_[at_index(p)];
  if (sums.empty()) return true;
  const int width = parts_[at_index(p)].columns + 1;
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
  const ClothPart<Real>& part = parts_[at_index(node.part)];
  return {std::max(node.cells.row - kPatchCells, 0),
          std::min(node.cells.row_end + kPatchCells, part.rows - 1),
          std::max(node.cells.column - kPatchCells, 0),
          std::min(node.cells.column_end + kPatchCells, part.columns - 1)};
}

/// Least eigenvalue that keeps balls of a radius [m] apart, if their features share no particle:
/// these are at least the height of a triangle apart in the fabric.
template <class Real>
Real PatchTree<Real>::least_spread(const Node& node, Real radius) const {
  const ClothPart<Real>& part = parts_[at_index(node.part)];
  const Real nearest =
      part.cell_u * part.cell_v / std::sqrt(part.cell_u * part.cell_u + part.cell_v * part.cell_v);
  return 2 * radius / nearest * Real(1 + kCullSlack) + Real(kCullSlack);
}

/// Whether the grown rectangle of a node of a grid is stretched out in one plane, which is kept.
/// One that was not waits for as many searches as it failed in, up to some, and is not tried in
/// these.
template <class Real>
bool PatchTree<Real>::find_spread(Index n, const PredictedMotion<Real>& motion) {
  Node& node = nodes_[at_index(n)];
  if (node.wait > 0) {
    --node.wait;
    return false;
  }
  Plane& plane = planes_[at_index(n)];
  const Real least = least_spread(node, motion.radius);
  const CellRange cells = grown(node);
  const bool spread = least < 1 && find_plane(motion, cells, node.part, plane) &&
                      is_spread(motion.start, plane, cells, node.part, least) &&
                      is_spread(motion.end, plane, cells, node.part, least);
  if (!spread && node.misses < kMostWaits) ++node.misses;
  node.wait = node.misses;
  return spread;
}

/// Tries the rectangle of a node, and else those of its children.
template <class Real>
void PatchTree<Real>::mark_spread(Index n, const PredictedMotion<Real>& motion) {
  Node& node = nodes_[at_index(n)];
  if (is_grid(node) && find_spread(n, motion)) {
    give_spread(n, grown(node));
    return;
  }
  node.spread = {};
  if (node.patch != kNone) return;
  mark_spread(node.left, motion);
  mark_spread(node.right, motion);
}

/// Finds the cells around a patch that are stretched out in one plane with it.
template <class Real>
const typename PatchTree<Real>::SpreadCells& PatchTree<Real>::spread_around(
    Index p, const PredictedMotion<Real>& motion) {
  SpreadCells& found = around_[at_index(p)];
  if (std::exchange(found.refit, refits_) == refits_) return found;
  const Node& node = node_of(p);
  const ClothPart<Real>& part = parts_[at_index(node.part)];
  const Real least = least_spread(node, motion.radius);
  // Widened, so that it fills a vector.
  CellRange cells = grown(node);
  cells.column = std::max(std::min(cells.column, part.columns - 1 - kMostSpreadCells), 0);
  cells.column_end = std::min(cells.column + kMostSpreadCells, part.columns - 1);
  Plane plane;
  found.row = cells.row;
  found.column = cells.column;
  found.bits = 0;
  if (least < 1 && find_plane(motion, grown(node), node.part, plane))
    found.bits = spread_cells(spread_pass(motion.start, plane, cells, node.part, least)) &
                 spread_cells(spread_pass(motion.end, plane, cells, node.part, least));
  return found;
}

template <class Real>
bool PatchTree<Real>::are_spread(Index p, Index q, const PredictedMotion<Real>& motion) {
  const Node &one = node_of(p), &other = node_of(q);
  if (!is_grid(one) || one.part != other.part) return false;
  const CellRange cells = {std::min(one.cells.row, other.cells.row),
                           std::max(one.cells.row_end, other.cells.row_end),
                           std::min(one.cells.column, other.cells.column),
                           std::max(one.cells.column_end, other.cells.column_end)};
  if (!grown(one).holds(cells)) return false;
  const auto holds = [&](const SpreadCells& around) {
    const auto width = static_cast<unsigned>(cells.column_end - cells.column);
    const std::uint64_t row = ((std::uint64_t{1} << width) - 1) << (cells.column - around.column);
    for (int r = cells.row; r < cells.row_end; ++r) {
      if ((~around.bits >> (kMostSpreadCells * (r - around.row)) & row) != 0) return false;
    }
    return true;
  };
  return holds(spread_around(p, motion)) ||
         (p != q && grown(other).holds(cells) && holds(spread_around(q, motion)));
}

/// Looks again at rectangles that were stretched out and have a changed particle. The triangles of
/// the others go on as before, so that in the same plane only those of changed ones are tested.
/// What was not stretched out is not tried before all is refitted.
template <class Real>
void PatchTree<Real>::renew_spread(Index n, const PredictedMotion<Real>& motion,
                                   const std::vector<char>& changed) {
  assert(motion.start.size() == changed.size() && motion.end.size() == changed.size());
  Node& node = nodes_[at_index(n)];
  if (is_grid(node)) {
    const CellRange cells = grown(node);
    if (!has_changed(node.part, cells)) return;
    if (node.spread.cells() > 0) {
      if (stays_spread(n, motion, changed)) return;
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
bool PatchTree<Real>::stays_spread(Index n, const PredictedMotion<Real>& motion,
                                   const std::vector<char>& changed) const {
  const Node& node = nodes_[at_index(n)];
  const Plane& plane = planes_[at_index(n)];
  const Real least = least_spread(node, motion.radius);
  const ClothPart<Real>& part = parts_[at_index(node.part)];
  const auto has = [&](int r, int c) {  // of both rows of a cell
    const auto i = static_cast<std::size_t>(part.particles.first + r * part.columns + c);
    return (changed[i] | changed[i + static_cast<std::size_t>(part.columns)]) != 0;
  };
  const auto tests = [&](const CellRange& cells) {
    return is_spread(motion.start, plane, cells, node.part, least) &&
           is_spread(motion.end, plane, cells, node.part, least);
  };
  const int end = node.spread.column_end;
  for (int r = node.spread.row; r < node.spread.row_end; ++r) {
    if (!has_changed(node.part, {r, r + 1, node.spread.column, end})) continue;
    for (int c = node.spread.column; c < end; ++c) {
      if (!has(r, c) && !has(r, c + 1)) continue;
      const int first = c;
      while (c < end && (has(r, c) || has(r, c + 1))) ++c;
      if (!tests({r, r + 1, first, c})) return false;
    }
  }
  return true;
}

template <class Real>
void PatchTree<Real>::give_spread(Index n, const CellRange& cells) {
  Node& node = nodes_[at_index(n)];
  node.spread = cells;
  node.misses = node.wait = 0;
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
  const ClothPart<Real>& part = parts_[at_index(p)];
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

template <class Real>
SpreadPass<Real> PatchTree<Real>::spread_pass(const QuadArray<Real>& x, const Plane& plane,
                                              const CellRange& cells, Index p, Real least) const {
  const ClothPart<Real>& part = parts_[at_index(p)];
  SpreadPass<Real> pass;
  pass.particles = part.columns;
  pass.cells = part.columns - 1;
  pass.x = x.data() + part.particles.first + cells.row * pass.particles + cells.column;
  pass.falls = falls_[at_index(p)].data() + cells.row * pass.cells + cells.column;
  pass.rows = cells.row_end - cells.row;
  pass.columns = cells.column_end - cells.column;
  const Real per_u = Real(1) / part.cell_u, per_v = Real(1) / part.cell_v;
  for (int k = 0; k < 3; ++k)
    pass.axes[at_index(k)] = {plane.u[k] * per_u, plane.v[k] * per_u, plane.u[k] * per_v,
                              plane.v[k] * per_v};
  pass.least = least;
  return pass;
}

template <class Real>
bool PatchTree<Real>::is_spread(const QuadArray<Real>& x, const Plane& plane,
                                const CellRange& cells, Index p, Real least) const {
  return weft::is_spread(spread_pass(x, plane, cells, p, least));
}

#define WEFT_INSTANTIATE(Real)                                                     \
  template void PatchTree<Real>::sum_changed(const std::vector<char>&);            \
  template void PatchTree<Real>::mark_spread(Index, const PredictedMotion<Real>&); \
  template void PatchTree<Real>::renew_spread(Index, const PredictedMotion<Real>&, \
                                              const std::vector<char>&);           \
  template bool PatchTree<Real>::are_spread(Index, Index, const PredictedMotion<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
