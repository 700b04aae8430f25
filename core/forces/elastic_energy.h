#pragma once

namespace weft {

/// Elastic energies of one evaluation [J], summed in double.
struct ElasticEnergy {
  double stretch = 0;
  double bending = 0;
  double largest_strain = 0;  ///< largest |l - L| / L of the structural and shear springs
};

}  // namespace weft
