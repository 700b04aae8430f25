// Frequencies of a strip's modes, and relaxation times from their decay.

#include "core/cloth/fabric_modes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/cloth/membrane.h"

namespace weft {
namespace {

/// Smallest positive root of cos x cosh x = -1.
constexpr double kFirstRootOfCantilever = 1.8751040687119612;

}  // namespace

double angular_frequency(const FabricDef& fabric, FabricMode mode, double length) {
  assert(length > 0 && fabric.areal_density > 0);
  const auto wave = [&](double stiffness) {
    return std::numbers::pi / length * std::sqrt(stiffness / fabric.areal_density);
  };
  if (mode == FabricMode::shear) return wave(fabric.shear);
  if (mode == FabricMode::stretch) {
    const double coupling = membrane_coupling(fabric);
    const double narrowed = fabric.stretch_weft > 0 ? coupling * coupling / fabric.stretch_weft : 0;
    return wave(std::max(fabric.stretch_warp - narrowed, 0.0));
  }
  const double root = kFirstRootOfCantilever / length;
  return root * root * std::sqrt(fabric.bending_warp / fabric.areal_density);
}

double relaxation_time(const FabricDef& fabric, FabricMode mode) {
  return mode == FabricMode::stretch ? fabric.stretch_damping
         : mode == FabricMode::shear ? fabric.shear_damping
                                     : fabric.bending_damping;
}

double relaxation_of_decay(double omega, double decay_time) {
  assert(omega > 0 && decay_time > 0);
  return 2 / (omega * omega * decay_time);
}

double relaxation_of_loss(double omega, double loss_factor) {
  assert(omega > 0 && loss_factor >= 0);
  return loss_factor / omega;
}

}  // namespace weft
