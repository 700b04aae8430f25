#pragma once

#include <cstddef>

#include "core/types.h"

namespace weft {

inline constexpr int kMeshBlock = 64;  ///< particles whose neighbours are gathered together

/// A block of particles of a mesh. In each slot every particle has one neighbour; who has none left
/// is its own, with zeros for numbers. `near` slots have a spring and a bending weight, `far` ones
/// a bending weight alone.
template <class Real>
struct MeshBlock {
  int near = 0, far = 0;
  const Index* neighbour = nullptr;      ///< of the whole model, kMeshBlock a slot
  const Real* rest_length = nullptr;     ///< by near slot [m]
  const Real* stiffness = nullptr;       ///< by near slot [N/m]
  const Real* bending_weight = nullptr;  ///< by slot: entry of the bending matrix [N/m]
};

/// What the kernel of a mesh reads and writes: three numbers a particle in the arrays of the whole
/// model, of which the mesh is a stretch.
template <class Real>
struct MeshView {
  const MeshBlock<Real>* block = nullptr;
  int blocks = 0;
  std::ptrdiff_t first = 0, count = 0;  ///< particles of the mesh
  Real damping_per_stiffness = 0;       ///< of the springs [s]
  Real* gathered = nullptr;  ///< scratch: kMeshBlock triples a slot, positions and velocities
};

}  // namespace weft
