#pragma once

#include "core/cloth/cloth_model.h"
#include "core/diagnostics/constants.h"
#include "core/types.h"

// Cusick's drape test (BS 5058): a round specimen lies centred on a disc, and the overhang falls
// into folds. The shadow under a lamp above is measured.

namespace weft {

struct DrapeMeasurement {
  double coefficient = 0;  ///< fraction of the overhanging ring that the shadow covers [%]
  int folds = 0;           ///< crests of the shadow's edge around the disc
  double droop = 0;        ///< mean height of the disc above the hem [m]
};

/// Measures the drape of one part of a model, seen from above along -y.
///
/// The coefficient is (shadow - disc) / (specimen - disc) with the specimen's own flat area; the
/// shadow is sampled at points 0.5 mm apart. A fold is a crest of the hem's distance from the
/// middle that rises by 2 mm on both sides, as on a hem that is round when flat.
/// @param x       positions of all particles [m], finite
/// @param centre  of the disc, at its height [m]
template <class Real>
DrapeMeasurement measure_drape(const ClothModel<Real>& model, const ClothPart<Real>& part,
                               const Vec3Array<Real>& x, const Vec3d& centre);

extern template DrapeMeasurement measure_drape(const ClothModel<float>&, const ClothPart<float>&,
                                               const Vec3Array<float>&, const Vec3d&);
extern template DrapeMeasurement measure_drape(const ClothModel<double>&, const ClothPart<double>&,
                                               const Vec3Array<double>&, const Vec3d&);

}  // namespace weft
