#pragma once

#include <cstddef>
#include <cstdint>

#include "core/types.h"

namespace weft {

inline constexpr int kMeshGroup = 16;  ///< particles of equal slots, worked on at once
inline constexpr int kMeshBlock = 64;  ///< particles that are sorted into groups among themselves

/// Way to a particle: how far behind the first one of the block it is in the model. Half the size
/// of its number, as lists are read anew each substep and do not stay in the cache.
using MeshWay = std::int16_t;

/// Particles of a block that pull about as many later ones. In each slot every one of them has one
/// neighbour; who has none left is its own. `near` slots have a spring and a bending weight, `far`
/// ones, which follow, a bending weight alone.
struct MeshGroup {
  std::uint8_t near = 0, far = 0;
  std::uint8_t members = 0;  ///< particles; the lanes behind them repeat the last one
  bool meets_last = false;   ///< the model's last particle is among them or their neighbours
};

/// What the kernel of a mesh reads: lists by group without gaps, as many as its slots tell. Each
/// pair of neighbours is worked on once, by the one that comes first in the mesh. What it is pulled
/// with is kept for the other one, who takes it with the opposite sign, in a ring that goes round
/// as soon as nobody needs what is overwritten.
template <class Real>
struct MeshView {
  const MeshGroup* group = nullptr;  ///< kMeshBlock / kMeshGroup a block
  const MeshWay* way = nullptr;      ///< the group's own particles, then by slot, kMeshGroup each
  /// By near slot rest lengths [m], stiffness [N/m] and entries of the bending matrix [N/m], by far
  /// slot minus the entries alone, kMeshGroup each.
  const Real* number = nullptr;
  const std::uint8_t* earlier = nullptr;  ///< by member how many earlier ones pull it
  const std::uint16_t* pull = nullptr;    ///< by member and earlier one: where in the ring
  Real* ring = nullptr;                   ///< pulls as quads [N], kMeshGroup a slot
  std::size_t ring_size = 0;              ///< quads
  std::ptrdiff_t first = 0, count = 0;    ///< particles of the mesh, within those of the model
  std::ptrdiff_t last = 0;                ///< last particle of the model
  Real damping_per_stiffness = 0;         ///< of the springs [s]
};

}  // namespace weft
