#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/diagnostics/swing.h"

// Measurements of textile tests.

namespace weft {

/// Textile test that a scene performs, and so the measurements of its first cloth.
enum class TextileTest {
  none,
  drape,       ///< Cusick's: the pinned middle of a round cloth is the support (drape.h)
  cantilever,  ///< a grid with pinned first columns, which overhangs by the others (cantilever.h)
  decay,       ///< such a grid, bent by a hand, let go and left to swing (swing.h)
};

/// A number with a name that ends in its unit, e.g. "drape_coefficient_percent".
struct NamedNumber {
  std::string name;
  double value = 0;
};

/// Results of the test on the first part of the model in its present state. Drape: the coefficient,
/// folds and droop, and the published band of the coefficient if the fabric is a preset with one.
/// Cantilever: droop, angle, bending length and rigidity. Both: the largest of these velocities,
/// which shows whether the cloth rests. Decay: amplitude, and once it has swung some times its
/// period, decay time, loss factor and the relaxation time of bending. Empty without a test, or if
/// the first part does not suit it: nothing is pinned, or for a strip it is not a grid or does not
/// overhang.
/// @param v        means over a tick: those at its end carry the fastest vibration of stiff cloth
/// @param gravity  its magnitude [m/s^2], to which the rigidity is proportional
/// @param swing    of the strip's end, by `deflection`
template <class Real>
std::vector<NamedNumber> measurements(TextileTest test, const ClothModel<Real>& model,
                                      const ClothState<Real>& state, const Vec3Array<Real>& v,
                                      double gravity, const Swing& swing);

/// How far the free end of a strip is from its clamp along the normal of the cloth at rest [m];
/// nothing if the first part is no such strip.
template <class Real>
std::optional<double> deflection(const ClothModel<Real>& model, const ClothState<Real>& state);

extern template std::vector<NamedNumber> measurements(TextileTest, const ClothModel<float>&,
                                                      const ClothState<float>&,
                                                      const Vec3Array<float>&, double,
                                                      const Swing&);
extern template std::vector<NamedNumber> measurements(TextileTest, const ClothModel<double>&,
                                                      const ClothState<double>&,
                                                      const Vec3Array<double>&, double,
                                                      const Swing&);
extern template std::optional<double> deflection(const ClothModel<float>&,
                                                 const ClothState<float>&);
extern template std::optional<double> deflection(const ClothModel<double>&,
                                                 const ClothState<double>&);

}  // namespace weft
