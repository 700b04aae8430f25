#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/forces/grid_pass.h"
#include "core/types.h"

// Elastic energy of a model.

namespace weft {

/// Computes the elastic energy of a cloth for solvers that do not step in GridPass: grids by vector
/// code, other parts element by element.
template <class Real>
class EnergyPass {
 public:
  /// Sizes all arrays for a cloth.
  void prepare(const ClothModel<Real>& model);

  /// Energies of membrane and bending, and the largest strain.
  /// @param x  of all particles of the model [m]
  ElasticEnergy elastic_energy(const ClothModel<Real>& model, const Vec3Array<Real>& x);

 private:
  std::vector<GridPass<Real>> grids_;  ///< per part
};

}  // namespace weft
