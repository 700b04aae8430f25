#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cloth/membrane_triangle.h"
#include "core/types.h"

// Layout of the lists that a mesh's kernels work on.

namespace weft {

inline constexpr int kMeshGroup = 16;   ///< particles with equal slots, processed together
inline constexpr int kMeshBlock = 128;  ///< particles that are sorted into groups among themselves

/// Offset of a particle in numbers (three per particle) from the block's first particle in the
/// model. Half the size of an index, because lists are read anew in each substep and do not stay in
/// the cache.
using MeshOffset = std::int16_t;

/// Pulls are addressed by their offset from the ring's start in pairs of numbers: a unit that
/// processors can address, and 16 bits reach far enough.
inline constexpr std::size_t kPullUnit = 2;

/// Position of a lane's quad in a slot of the ring: the order in which transposition yields them.
constexpr std::size_t quad_of_lane(std::size_t lane) {
  return 4 * (lane % 4) + lane / 4;
}

/// Particles of a block that pull about as many later neighbours and are pulled by as many earlier
/// ones. In each slot each of them has one neighbour. `near` slots have a spring and a bending
/// weight, the following `far` slots only a bending weight; a particle without a further later
/// neighbour uses itself. A particle without a further earlier neighbour takes nothing. Lanes
/// without a particle repeat the last.
struct MeshGroup {
  std::uint8_t near = 0, far = 0, earlier = 0;  ///< numbers of slots
  bool meets_last = false;  ///< the model's last particle is among them or their neighbours
};

/// The pairs of triangles that are computed before the particles of a block: those whose earliest
/// corner is in it. They are in groups of kMeshGroup; the last group may begin the next block's.
struct MeshPairs {
  std::uint32_t groups = 0;
  bool meets_last = false;  ///< the model's last particle is a corner
};

/// Corners and numbers of the rest shape of a TrianglePair.
inline constexpr std::size_t kPairCorners = 4, kPairNumbers = 8;

/// Strains of both its triangles, and pairs of its corners.
inline constexpr std::size_t kPairStrains = 6, kPairLinks = 6;

/// Input of a mesh's kernel: lists per group without gaps, with lengths given by its slots. Each
/// pair of neighbours is computed once, by the one that comes first in the mesh. Its pull is stored
/// for the other particle, which takes it with the opposite sign, in a ring that wraps around once
/// the overwritten pulls are no longer needed. Pairs of triangles store what they pull at each
/// corner in the same ring, one slot a corner.
template <class Real>
struct MeshView {
  const MeshGroup* group = nullptr;    ///< kMeshBlock / kMeshGroup per block
  const MeshOffset* offset = nullptr;  ///< the group's own particles, then by slot, kMeshGroup each
  /// By near slot rest lengths [m], stiffness [N/m] and entries of the bending matrix [N/m], by far
  /// slot only the negative entries, kMeshGroup each.
  const Real* number = nullptr;
  const MeshPairs* pairs = nullptr;    ///< by block; null: none, but springs
  const MeshOffset* corner = nullptr;  ///< of groups of pairs, kMeshGroup for each corner
  const Real* shape = nullptr;         ///< and for each number
  const Real* link = nullptr;          ///< and for each two corners, 0-1 0-2 0-3 1-2 1-3 2-3, their
                                       ///< negative entry of the bending matrix [N/m]; null: none
  Real* strain = nullptr;              ///< and for each strain, as last computed
  Real substeps_per_second = 0;        ///< if the rates of strain are the differences since then;
                                       ///< 0: they follow from the velocities
  MembraneTensor<Real> tensor;
  const std::uint16_t* pull = nullptr;  ///< offset in the ring by earlier slot, kMeshGroup each
  Real* ring = nullptr;       ///< pulls as quads [N], kMeshGroup per slot; then a slot of zeros
  std::size_t ring_size = 0;  ///< quads without that slot
  std::ptrdiff_t first = 0, count = 0;  ///< range of the mesh within the model's particles
  std::ptrdiff_t last = 0;              ///< last particle of the model
  Real damping_per_stiffness = 0;       ///< of the springs [s]
};

}  // namespace weft
