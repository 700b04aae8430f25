#pragma once

#include <array>
#include <cstdint>

#include "core/contact/feature_pair.h"
#include "core/types.h"

// What ClothGuard tells of: its pairs, its counts, and paths that need no pairs.

namespace weft {

/// Two features of cloths that could meet before pairs are collected again.
template <class Real>
struct GuardedPair {
  PairKind kind = PairKind::vertex_triangle;
  bool open = false;  ///< not apart, or free to part (ClothTangles): nothing is promised about it
  bool gone = false;  ///< looked at again since, as one of its particles left its path
  std::array<Index, 4> particle = {0, 0, 0, 0};
  Index a = 0, b = 0;        ///< particle and triangle, or two edges, the lower one first
  Real bound = 0;            ///< the features at their anchors are at least so far apart [m]
  std::uint32_t listed = 0;  ///< search for critical pairs that met it last
  /// Of each particle its next pair, if it came after all were collected: number x 4 + place.
  std::array<Index, 4> next = {kNone, kNone, kNone, kNone};
};

/// Names a pair.
template <class Real>
std::uint64_t key_of(const GuardedPair<Real>& pair) {
  return (static_cast<std::uint64_t>(pair.kind == PairKind::edge_edge) << 63) |
         (static_cast<std::uint64_t>(pair.a) << 31) | static_cast<std::uint64_t>(pair.b);
}

/// What the guard did since it was built; sums of lengths of single particles' motions.
struct GuardCounts {
  double wanted = 0;              ///< motion that particles in pairs wanted [m]
  double truncated = 0;           ///< part of it that was not allowed [m]
  std::uint64_t collections = 0;  ///< of all pairs
  std::uint64_t renewals = 0;     ///< of the pairs of some particles
  std::uint64_t anchored = 0, critical = 0;
  std::uint64_t quiet = 0;  ///< steps that one bound for all particles certified
  std::uint64_t halts = 0;  ///< steps in which nobody moved, as no way was found to let some
  std::uint64_t calm = 0;   ///< steps that went by along calm paths, without a look at any particle
};

/// Straight paths of all particles. While no two features can meet that go along them, all that is
/// to be looked at is that everybody stays near his path, but for a way that all have in common.
template <class Real>
struct CalmPaths {
  Vec3Array<Real> base;      ///< where each path is at time 0 [m]
  Vec3Array<Real> velocity;  ///< along it [m/s]
  Real fastest = 0;          ///< the largest of these [m/s]
  Real time = 0;             ///< now [s]
  Real horizon = 0;          ///< until then the paths hold [s]
  Real reach = 0;            ///< that nobody may be farther off his path [m]
  std::uint64_t number = 0;  ///< of these paths; others have another one
};

}  // namespace weft
