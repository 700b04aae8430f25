#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// Strain statistics.

namespace weft {

/// Strain of the cloth at one instant: |l - L| / L over its structural and shear springs, and the
/// principal strain over its membrane triangles.
struct StrainStatistics {
  double largest = 0;
  double p99 = 0;  ///< 99th percentile: the element of rank floor(0.99 (n - 1))
};

/// @param x        positions of all particles [m], finite
/// @param scratch  keeps its capacity between calls
template <class Real>
StrainStatistics strain_statistics(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                                   std::vector<Real>& scratch);

extern template StrainStatistics strain_statistics(const ClothModel<float>&,
                                                   const Vec3Array<float>&, std::vector<float>&);
extern template StrainStatistics strain_statistics(const ClothModel<double>&,
                                                   const Vec3Array<double>&, std::vector<double>&);

}  // namespace weft
