// Softens the springs of a model.

#include "core/cloth/softening.h"

#include <cassert>
#include <cmath>

namespace weft {

template <class Real>
void soften(double softness, ClothModel<Real>& model) {
  assert(softness >= kLeastSoftness && softness <= 1);
  // c = 2 zeta k / omega, and omega scales with the root.
  const double root = std::sqrt(softness);
  const Real stiffness = static_cast<Real>(softness), damping = static_cast<Real>(root);
  for (Spring<Real>& spring : model.springs) {
    spring.stiffness *= stiffness;
    spring.damping *= damping;
  }
  for (ThreadLock<Real>& lock : model.locks) lock.stiffness *= stiffness;
  for (ClothPart<Real>& part : model.parts) {
    MembraneTensor<Real>& tensor = part.membrane_tensor;
    for (Real* number : {&tensor.warp, &tensor.weft, &tensor.coupling, &tensor.shear})
      *number *= stiffness;
    tensor.stretch_time /= damping;
    tensor.shear_time /= damping;
    part.bounds.membrane_omega2 *= softness;
    part.bounds.membrane_shear_omega2 *= softness;
    part.bounds.locking_omega2 *= softness;
    part.bounds.membrane_damping_rate *= root;
    if (!part.grid_springs) continue;
    GridSprings<Real>& springs = *part.grid_springs;
    springs.warp *= stiffness;
    springs.weft *= stiffness;
    springs.shear *= stiffness;
    springs.misfit *= stiffness;
    for (Real* time : {&springs.warp_time, &springs.weft_time, &springs.shear_time})
      *time /= damping;
  }
}

template void soften(double, ClothModel<float>&);
template void soften(double, ClothModel<double>&);

}  // namespace weft
