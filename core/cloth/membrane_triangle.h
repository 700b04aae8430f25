#pragma once

#include "core/types.h"

// The membrane of a mesh: triangles of constant strain.

namespace weft {

/// The membrane's tensor in the axes of the threads, and its dashpots: stress is that of the strain
/// plus a relaxation time times the rate of strain (Kelvin-Voigt).
template <class Real>
struct MembraneTensor {
  Real warp = 0, weft = 0;  ///< C11 = Y_w, C22 = Y_f [N/m]
  Real coupling = 0;        ///< C12; see membrane_coupling() [N/m]
  Real shear = 0;           ///< C66 = G [N/m]
  Real stretch_time = 0;    ///< relaxation time of both stretches [s]
  Real shear_time = 0;      ///< and of shear [s]
};

/// A triangle with the gradients of its linear functions in the fabric's axes: w_u = u1 (x1 - x0) +
/// u2 (x2 - x0) is the derivative of the position along the warp, and w_v along the weft. The
/// gradient of corner 0 is minus the sum of both.
template <class Real>
struct MembraneTriangle {
  Triangle x = {0, 0, 0};
  Real u1 = 0, u2 = 0;  ///< along u, of corners 1 and 2 [1/m]
  Real v1 = 0, v2 = 0;  ///< along v [1/m]
  Real area = 0;        ///< at rest [m^2]
};

}  // namespace weft
