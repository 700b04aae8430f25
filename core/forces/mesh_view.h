#pragma once

#include <cstddef>
#include <cstdint>

#include "core/types.h"

namespace weft {

inline constexpr int kMeshGroup = 16;   ///< particles of equal slots, worked on at once
inline constexpr int kMeshBlock = 128;  ///< particles that are sorted into groups among themselves

/// Way to a particle: by how many numbers it stands behind the first one of the block in the model,
/// three a particle. Half the size of an index, as lists are read anew each substep and do not stay
/// in the cache.
using MeshWay = std::int16_t;

/// Pulls are found by how many pairs of numbers they stand behind the ring's start: a unit that
/// processors can address, and 16 bits lead far enough.
inline constexpr std::size_t kPullUnit = 2;

/// Where a slot of the ring has the quad of a lane: as they come out when they are transposed.
constexpr std::size_t quad_of_lane(std::size_t lane) {
  return 4 * (lane % 4) + lane / 4;
}

/// Particles of a block that pull about as many later ones and are pulled by as many earlier ones.
/// In each slot every one of them has one neighbour. `near` slots have a spring and a bending
/// weight, `far` ones, which follow, a bending weight alone; who has no later neighbour left there
/// is its own. Who has no earlier one left takes nothing. Lanes without a particle repeat the last.
struct MeshGroup {
  std::uint8_t near = 0, far = 0, earlier = 0;  ///< slots
  bool meets_last = false;  ///< the model's last particle is among them or their neighbours
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
  const std::uint16_t* pull = nullptr;  ///< by earlier slot where in the ring, kMeshGroup each
  Real* ring = nullptr;       ///< pulls as quads [N], kMeshGroup a slot; then one of zeros
  std::size_t ring_size = 0;  ///< quads without that one
  std::ptrdiff_t first = 0, count = 0;  ///< particles of the mesh, within those of the model
  std::ptrdiff_t last = 0;              ///< last particle of the model
  Real damping_per_stiffness = 0;       ///< of the springs [s]
};

}  // namespace weft
