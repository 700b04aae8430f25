// Sizes the arrays of relaxation.

#include "core/solver/relaxation.h"

namespace weft {

template <class Real>
void RelaxationWorkspace<Real>::prepare(const ClothModel<Real>& model) {
  for (Vec3Array<Real>* array : {&force, &external, &wanted})
    array->assign(model.mass.size(), Vec3<Real>::Zero());
  multiplier.assign(model.springs.size(), Real(0));
  membrane_multiplier.assign(model.membrane.size(), Vec3<Real>::Zero());
  energy.prepare(model);
  grids.assign(model.parts.size(), {});
  for (std::size_t p = 0; p < grids.size(); ++p) grids[p].prepare(model.parts[p]);
}

template struct RelaxationWorkspace<float>;
template struct RelaxationWorkspace<double>;

}  // namespace weft
