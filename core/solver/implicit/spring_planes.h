#pragma once

#include <array>

#include "core/cloth/cloth_model.h"
#include "core/math/aligned_vector.h"
#include "core/solver/implicit/spring_grid.h"

// A grid's springs in planes, for linearisation.

namespace weft {

/// The springs of a whole grid by kind and first cell, in the finest level's layout; 0 where there
/// is none.
template <class Real>
struct SpringPlanes {
  std::array<AlignedVector<Real>, 4> stiffness;    ///< by GridSpring [N/m]
  std::array<AlignedVector<Real>, 4> damping;      ///< [N s/m]
  std::array<AlignedVector<Real>, 4> rest_length;  ///< [m]
  AlignedVector<Real> forces;                      ///< of two rows of springs; see `linearise`

  SpringPlanes(const GridLayout& layout, const ClothModel<Real>& model,
               const ClothPart<Real>& part);
};

/// Forces of springs, dashpots and bending on all particles, and the blocks of the springs
/// (SpringTerm), factored.
/// @param rate   derivative of velocities by positions [1/s]
/// @param x, v   in the grid's layout [m], [m/s]
/// @param force  receives the forces, also of pinned particles [N]
template <class Real>
void linearise(SpringPlanes<Real>& springs, Real rate, const Real* x, const Real* v,
               SpringGrid<Real>& grid, Real* force);

}  // namespace weft
