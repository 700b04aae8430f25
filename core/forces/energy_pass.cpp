// Sums elastic energies over the parts of a model.

#include "core/forces/energy_pass.h"

#include <cassert>

namespace weft {

template <class Real>
void EnergyPass<Real>::prepare(const ClothModel<Real>& model) {
  grids_.clear();
  grids_.resize(model.parts.size());
  for (std::size_t p = 0; p < grids_.size(); ++p) grids_[p].prepare(model.parts[p]);
}

template <class Real>
ElasticEnergy EnergyPass<Real>::elastic_energy(const ClothModel<Real>& model,
                                               const Vec3Array<Real>& x) {
  assert(grids_.size() == model.parts.size() && "prepared for this model");
  assert(x.size() == model.mass.size());
  ElasticEnergy sum;
  for (std::size_t p = 0; p < grids_.size(); ++p) {
    GridPass<Real>& grid = grids_[p];
    if (grid.fits()) grid.load_positions(x);
    add(grid.fits() ? grid.elastic_energy() : weft::elastic_energy(model, model.parts[p], x), sum);
  }
  return sum;
}

template class EnergyPass<float>;
template class EnergyPass<double>;

}  // namespace weft
