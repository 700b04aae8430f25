#pragma once

#include <functional>

#include "core/cloth/cloth_model.h"

// Hinges between adjacent triangles.

namespace weft {

/// Parameters of a hinge besides its geometry.
struct HingeSettings {
  double rest_angle = 0;       ///< [rad]
  bool add_own_angle = false;  ///< add the hinge's angle in the rest positions
  double damping = 0;          ///< per stiffness [s]
  bool sine_form = false;      ///< see Hinge::sine_form
  /// Rigidity of a hinge over an edge (|du|, |dv|) in the material [N m]; 0: no hinge there.
  std::function<double(double du, double dv)> rigidity;
};

/// Fills `model.edges` with the unique edges of its triangles and `model.hinges` with one hinge per
/// pair of triangles that share an edge, ordered by the edge's ends. Rest positions, material
/// coordinates, triangles and their areas must be set.
template <class Real>
void connect_triangles(const HingeSettings& settings, ClothModel<Real>& model);

}  // namespace weft
