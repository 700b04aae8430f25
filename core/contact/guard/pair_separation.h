#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/contact/feature_pair.h"
#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// Certified gaps of many pairs at once, in vector code.

namespace weft {

/// Pairs are separated in vectors of at most this many.
inline constexpr std::size_t kPairPadding = 8;

/// Many pairs of one kind, and how their sides lie apart: one column a number, with room for whole
/// vectors; entries beyond `count` are unspecified. As in PairSeparation, but along the line of
/// closest points alone: where that gap is not above kCloseGap, `separate_pair` may know better.
template <class Real>
struct PairColumns {
  PairKind kind = PairKind::vertex_triangle;
  std::size_t count = 0;                       ///< of pairs
  std::vector<Index> a, b;                     ///< features
  std::array<std::vector<Index>, 4> particle;  ///< as GuardedPair has them
  std::vector<Real> gap;                       ///< certified, along the normal [m]
  std::vector<Real> end_gap;                   ///< along the same normal, at the end of the motion
  std::array<std::vector<Real>, 3> normal;     ///< from the second side to the first
  std::array<std::vector<Real>, 4> weight;     ///< of the closest points

  std::size_t size() const { return count; }
  void clear() { count = 0; }
  void add(Index first, Index second, const std::array<Index, 4>& particles) {
    if (count == a.size()) make_room();
    a[count] = first;
    b[count] = second;
    for (std::size_t k = 0; k < 4; ++k) particle[k][count] = particles[k];
    ++count;
  }
  void make_room();
  /// All that is known of a pair; exact where it is near.
  /// @param x  positions that the columns were separated with [m]
  PairSeparation<Real> separation(std::size_t k, const QuadArray<Real>& x) const;
  /// Its gap alone.
  Real certified_gap(std::size_t k, const QuadArray<Real>& x) const {
    return gap[k] > static_cast<Real>(kCloseGap) ? gap[k] : separation(k, x).gap;
  }
};

/// Columns of either kind of pair.
template <class Real>
class ColumnsByKind {
 public:
  ColumnsByKind() {
    for (const PairKind kind : {PairKind::vertex_triangle, PairKind::edge_edge})
      (*this)[kind].kind = kind;
  }
  PairColumns<Real>& operator[](PairKind kind) { return both_[static_cast<std::size_t>(kind)]; }
  void clear() {
    for (PairColumns<Real>& columns : both_) columns.clear();
  }
  auto begin() { return both_.begin(); }
  auto end() { return both_.end(); }

 private:
  std::array<PairColumns<Real>, 2> both_;
};

/// Fills the columns from `gap` on.
/// @param x         positions [m]
/// @param end       positions for `end_gap`; if it is x, that column is left as it is
/// @param executor  works through many pairs in chunks; may be null
template <class Real>
void separate_pairs(const QuadArray<Real>& x, const QuadArray<Real>& end, PairColumns<Real>& pairs,
                    Executor* executor = nullptr);

}  // namespace weft
