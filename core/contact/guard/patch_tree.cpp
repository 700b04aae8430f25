// Builds the tree of patches, refits it, and finds pairs of patches that may meet.

#include "core/contact/guard/patch_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/cloth/neighbours.h"

namespace weft {
namespace {

/// A patch of a mesh that is no grid has at most so many triangles.
constexpr std::size_t kPatchTriangles = 8;

/// Looks up the corners of a patch's features, and marks the features with each of its particles.
template <class Patch>
void give_corners(const std::vector<Edge>& edges, const std::vector<Triangle>& triangles,
                  Patch& patch) {
  patch.having.assign(patch.particles.size(), {});
  const auto add = [&](const auto& particles, std::uint32_t PatchMarks::*kind, auto& corners) {
    auto& places = corners.emplace_back();
    for (std::size_t k = 0; k < particles.size(); ++k) {
      const auto begin = patch.particles.begin(), end = patch.particles.end();
      places[k] = static_cast<std::uint8_t>(std::lower_bound(begin, end, particles[k]) - begin);
      patch.having[places[k]].*kind |= 1u << (corners.size() - 1);
    }
  };
  for (const Index i : patch.vertices)
    add(std::array{i}, &PatchMarks::vertices, patch.vertex_corners);
  for (const Index e : patch.edges) add(edges[at_index(e)], &PatchMarks::edges, patch.edge_corners);
  for (const Index t : patch.triangles)
    add(triangles[at_index(t)], &PatchMarks::triangles, patch.triangle_corners);
}

}  // namespace

template <class Real>
PatchTree<Real>::PatchTree(const ClothModel<Real>& model) : parts_(model.parts) {
  const auto count = static_cast<Index>(parts_.size());
  falls_.resize(parts_.size());
  for (Index p = 0; p < count; ++p) {
    if (parts_[at_index(p)].rows > 0) build_grid(model, p);
  }
  // Recursively: a node over all parts from `first`, `count` of them.
  const auto build = [&](auto&& self, Index first, Index parts_left) -> Index {
    if (parts_left > 1) {
      const auto node = static_cast<Index>(nodes_.size());
      nodes_.emplace_back();
      const Index left = self(self, first, parts_left / 2);
      const Index right = self(self, first + parts_left / 2, parts_left - parts_left / 2);
      Node& made = nodes_[at_index(node)];
      made.left = left;
      made.right = right;
      made.triangles = nodes_[at_index(left)].triangles + nodes_[at_index(right)].triangles;
      return node;
    }
    const ClothPart<Real>& part = parts_[at_index(first)];
    if (part.rows > 0) return split_grid(model, first, {0, part.rows - 1, 0, part.columns - 1});
    std::vector<Index> list;
    for (Index t = part.triangles.first; t < part.triangles.end(); ++t) list.push_back(t);
    return split_mesh(model, first, list, 0, list.size());
  };
  if (count > 0) build(build, 0, count);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    for (const Index below : {nodes_[n].left, nodes_[n].right}) {
      if (below != kNone) nodes_[at_index(below)].above = static_cast<Index>(n);
    }
  }
  planes_.resize(nodes_.size());
  around_.resize(patches_.size());
  give_features(model);
  give_patches(model.mass.size());
}

/// Lists the patches of each particle.
template <class Real>
void PatchTree<Real>::give_patches(std::size_t particles) {
  patches_begin_.assign(particles + 1, 0);
  for (const Patch& patch : patches_) {
    for (const Index i : patch.particles) ++patches_begin_[at_index(i) + 1];
  }
  std::partial_sum(patches_begin_.begin(), patches_begin_.end(), patches_begin_.begin());
  patches_with_.resize(static_cast<std::size_t>(patches_begin_.back()));
  std::vector<Index> next = patches_begin_;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    for (const Index i : patches_[p].particles)
      patches_with_[at_index(next[at_index(i)]++)] = static_cast<Index>(p);
  }
}

/// Finds the diagonal of each cell: where it falls, a triangle has the cell's first corner and the
/// last.
template <class Real>
void PatchTree<Real>::build_grid(const ClothModel<Real>& model, Index p) {
  const ClothPart<Real>& part = parts_[at_index(p)];
  std::vector<Real>& falls = falls_[at_index(p)];
  const int cells = (part.rows - 1) * (part.columns - 1);
  assert(part.triangles.count == 2 * cells);
  for (int cell = 0; cell < cells; ++cell) {
    const Triangle& one =
        model.triangles[static_cast<std::size_t>(part.triangles.first + 2 * cell)];
    const Index first =
        part.particles.first + cell / (part.columns - 1) * part.columns + cell % (part.columns - 1);
    const auto has = [&](Index i) { return std::find(one.begin(), one.end(), i) != one.end(); };
    falls.push_back(has(first) && has(first + part.columns + 1) ? Real(1) : Real(0));
  }
}

template <class Real>
Index PatchTree<Real>::split_grid(const ClothModel<Real>& model, Index p, const CellRange& cells) {
  const ClothPart<Real>& part = parts_[at_index(p)];
  const int rows = cells.row_end - cells.row, columns = cells.column_end - cells.column;
  if (rows <= kPatchCells && columns <= kPatchCells) {
    std::vector<Index> triangles;
    for (int r = cells.row; r < cells.row_end; ++r) {
      for (int c = cells.column; c < cells.column_end; ++c) {
        const Index t = part.triangles.first + 2 * (r * (part.columns - 1) + c);
        triangles.insert(triangles.end(), {t, t + 1});
      }
    }
    const Index node = add_patch(model, p, triangles);
    nodes_[at_index(node)].cells = cells;
    return node;
  }
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  CellRange first = cells, second = cells;
  if (rows >= columns)
    first.row_end = second.row = cells.row + rows / 2;
  else
    first.column_end = second.column = cells.column + columns / 2;
  const Index left = split_grid(model, p, first), right = split_grid(model, p, second);
  Node& made = nodes_[at_index(node)];
  made.left = left;
  made.right = right;
  made.part = p;
  made.cells = cells;
  made.triangles = 2 * cells.cells();
  return node;
}

/// Halves a list of triangles by place until patches are left.
template <class Real>
Index PatchTree<Real>::split_mesh(const ClothModel<Real>& model, Index p, std::vector<Index>& list,
                                  std::size_t begin, std::size_t end) {
  const auto from = list.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto to = list.begin() + static_cast<std::ptrdiff_t>(end);
  if (end - begin <= kPatchTriangles) return add_patch(model, p, std::vector<Index>(from, to));
  const auto sum_of = [&](Index t) -> Vec3<Real> {
    Vec3<Real> sum = Vec3<Real>::Zero();
    for (const Index i : model.triangles[at_index(t)]) sum += model.rest_positions[at_index(i)];
    return sum;
  };
  QuadBox<Real> box;
  for (auto t = from; t != to; ++t) box.add(to_quad(sum_of(*t)));
  int axis = 0;
  to_vector(box.upper - box.lower).maxCoeff(&axis);
  std::sort(from, to, [&](Index s, Index t) {
    const Real a = sum_of(s)[axis], b = sum_of(t)[axis];
    return a < b || (a == b && s < t);
  });
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  const std::size_t middle = begin + (end - begin) / 2;
  const Index left = split_mesh(model, p, list, begin, middle);
  const Index right = split_mesh(model, p, list, middle, end);
  Node& made = nodes_[at_index(node)];
  made.left = left;
  made.right = right;
  made.part = p;
  made.triangles = static_cast<Index>(end - begin);
  return node;
}

template <class Real>
Index PatchTree<Real>::add_patch(const ClothModel<Real>& model, Index part,
                                 const std::vector<Index>& triangles) {
  Patch patch;
  patch.triangles = triangles;
  for (const Index t : triangles) {
    const Triangle& corners = model.triangles[at_index(t)];
    patch.particles.insert(patch.particles.end(), corners.begin(), corners.end());
  }
  std::sort(patch.particles.begin(), patch.particles.end());
  patch.particles.erase(std::unique(patch.particles.begin(), patch.particles.end()),
                        patch.particles.end());
  Node node;
  node.patch = static_cast<Index>(patches_.size());
  node.part = part;
  node.triangles = static_cast<Index>(triangles.size());
  patches_.push_back(std::move(patch));
  node_of_.push_back(static_cast<Index>(nodes_.size()));
  nodes_.push_back(node);
  return node_of_.back();
}

/// Each particle and edge to the first patch that has it.
template <class Real>
void PatchTree<Real>::give_features(const ClothModel<Real>& model) {
  const Neighbours neighbours(model.mass.size(), model.edges);
  std::vector<char> given(model.mass.size(), 0), edge_given(model.edges.size(), 0);
  for (Patch& patch : patches_) {
    for (const Index i : patch.particles) {
      if (!std::exchange(given[at_index(i)], 1)) patch.vertices.push_back(i);
    }
    for (const Index t : patch.triangles) {
      const Triangle& corners = model.triangles[at_index(t)];
      for (std::size_t k = 0; k < 3; ++k) {
        for (const auto& [edge, other] : neighbours.of(at_index(corners[k]))) {
          if (other == corners[(k + 1) % 3] && !std::exchange(edge_given[at_index(edge)], 1))
            patch.edges.push_back(edge);
        }
      }
    }
    give_corners(model.edges, model.triangles, patch);
  }
}

template <class Real>
void PatchTree<Real>::fit_box(Node& node, const PredictedMotion<Real>& motion) const {
  node.box = {};
  if (node.patch == kNone) {
    node.box.add(nodes_[at_index(node.left)].box);
    node.box.add(nodes_[at_index(node.right)].box);
    return;
  }
  for (const Index i : patches_[at_index(node.patch)].particles) {
    node.box.add(motion.start[at_index(i)]);
    node.box.add(motion.end[at_index(i)]);
  }
  node.box = node.box.grown(motion.radius + motion.margin);
}

template <class Real>
void PatchTree<Real>::refit(const PredictedMotion<Real>& motion, bool cull) {
  assert(motion.start.size() == motion.end.size() && motion.radius >= 0);
  ++refits_;
  for (std::size_t n = nodes_.size(); n-- > 0;) fit_box(nodes_[n], motion);
  for (Node& node : nodes_) node.spread = {};
  if (!cull || nodes_.empty()) return;
  mark_spread(0, motion);
}

template <class Real>
void PatchTree<Real>::forget() {
  for (Node& node : nodes_) node.misses = node.wait = 0;
}

/// Marks the patches of some particles and the nodes above them, and no others.
template <class Real>
void PatchTree<Real>::mark(const std::vector<Index>& particles) {
  const auto mark_up = [&](Index patch, bool marked) {
    for (Index n = node_of_[at_index(patch)]; n != kNone;) {
      Node& node = nodes_[at_index(n)];
      if (node.marked == marked) return;
      node.marked = marked;
      n = node.above;
    }
  };
  for (const Index p : marked_) mark_up(p, false);
  marked_.clear();
  for (const Index k : particles) {
    const auto i = at_index(k);
    for (Index at = patches_begin_[i]; at < patches_begin_[i + 1]; ++at) {
      const Index p = patches_with_[at_index(at)];
      if (!is_marked(p)) marked_.push_back(p);
      mark_up(p, true);
    }
  }
}

/// Fits boxes around the marked nodes, from below.
template <class Real>
void PatchTree<Real>::fit_marked(Index n, const PredictedMotion<Real>& motion) {
  Node& node = nodes_[at_index(n)];
  if (!node.marked) return;
  if (node.patch == kNone) {
    fit_marked(node.left, motion);
    fit_marked(node.right, motion);
  }
  fit_box(node, motion);
}

template <class Real>
void PatchTree<Real>::refit_changed(const PredictedMotion<Real>& motion,
                                    const std::vector<Index>& particles,
                                    const std::vector<char>& changed) {
  assert(motion.start.size() == changed.size());
  ++refits_;
  mark(particles);
  if (nodes_.empty()) return;
  fit_marked(0, motion);
  sum_changed(changed);
  renew_spread(0, motion, changed);
}

template class PatchTree<float>;
template class PatchTree<double>;

}  // namespace weft
