#pragma once

#include <functional>

#include "core/cloth/cloth_model.h"

namespace weft {

/// What a hinge is made of besides its shape.
struct HingeSettings {
  double rest_angle = 0;       ///< [rad]
  bool add_own_angle = false;  ///< add the angle that the hinge has in the rest positions
  double damping = 0;          ///< per stiffness [s]
  bool sine_form = false;      ///< see Hinge::sine_form
  /// Rigidity of a hinge whose edge spans (|du|, |dv|) in the material [N m]; 0: no hinge there.
  std::function<double(double du, double dv)> rigidity;
};

/// Fills `model.edges` with the unique edges of its triangles and `model.hinges` with one hinge for
/// each pair of triangles that share an edge, ordered by the edge's ends. The model has rest
/// positions, material coordinates, triangles and their areas already.
template <class Real>
void connect_triangles(const HingeSettings& settings, ClothModel<Real>& model);

}  // namespace weft
