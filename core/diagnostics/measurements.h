#pragma once

#include <string>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

namespace weft {

/// Which test of textiles a scene is, and so what is measured of its first cloth.
enum class TextileTest {
  none,
  drape,       ///< Cusick's: a round cloth whose pinned middle is the support (drape.h)
  cantilever,  ///< a grid whose first columns are pinned hangs over by the others (cantilever.h)
};

/// A number with a name that ends in its unit, e.g. "drape_coefficient_percent".
struct NamedNumber {
  std::string name;
  double value = 0;
};

/// What the test reads off the first part of the model as it is now: for the drape coefficient,
/// folds and droop, and the published band of the coefficient if the fabric is a preset with one;
/// for the cantilever droop, angle, bending length and rigidity; for both the largest speed, so
/// that one sees whether it rests. Empty for no test, and where the first part does not fit the
/// test: nothing pinned, or for the cantilever no grid or nothing that hangs over.
/// @param gravity  its size [m/s^2], which the rigidity is in proportion to
template <class Real>
std::vector<NamedNumber> measurements(TextileTest test, const ClothModel<Real>& model,
                                      const ClothState<Real>& state, double gravity);

extern template std::vector<NamedNumber> measurements(TextileTest, const ClothModel<float>&,
                                                      const ClothState<float>&, double);
extern template std::vector<NamedNumber> measurements(TextileTest, const ClothModel<double>&,
                                                      const ClothState<double>&, double);

}  // namespace weft
