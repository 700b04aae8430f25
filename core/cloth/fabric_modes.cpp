// Frequencies of a strip's modes, and their decay from relaxation times and back.

#include "core/cloth/fabric_modes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/cloth/grid_springs.h"
#include "core/cloth/membrane.h"

namespace weft {
namespace {

/// Smallest positive root of cos x cosh x = -1.
constexpr double kFirstRootOfCantilever = 1.8751040687119612;

/// What a grid narrows along the weft per strain along the warp: C12 = G.
double narrowing_of_grid(const FabricDef& fabric) {
  return fabric.stretch_weft > 0 ? fabric.shear / fabric.stretch_weft : 0;
}

/// The diagonals' parts of both stretch stiffnesses [N/m].
struct DiagonalShares {
  double warp = 0, weft = 0;
};

DiagonalShares shares_of_diagonals(const FabricDef& fabric, double cell_u, double cell_v) {
  assert(cell_u > 0 && cell_v > 0);
  const double ratio2 = cell_u * cell_u / (cell_v * cell_v);
  return {fabric.shear * ratio2, fabric.shear / ratio2};
}

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

double stretch_relaxation_on_grid(const FabricDef& fabric, double cell_u, double cell_v) {
  const SpringTimes times = grid_spring_times(fabric, cell_u, cell_v, 0);
  const DiagonalShares share = shares_of_diagonals(fabric, cell_u, cell_v);
  const double narrowing = narrowing_of_grid(fabric),
               modulus = fabric.stretch_warp - narrowing * fabric.shear;
  assert(modulus > 0);
  const auto damped = [&](double stiffness, double diagonals, double time) {
    return time * std::max(stiffness - diagonals, 0.0) + times.shear * diagonals;
  };
  const double d11 = damped(fabric.stretch_warp, share.warp, times.warp),
               d22 = damped(fabric.stretch_weft, share.weft, times.weft),
               d12 = times.shear * fabric.shear;
  return (d11 - 2 * narrowing * d12 + narrowing * narrowing * d22) / modulus;
}

double stretch_damping_on_grid(const FabricDef& fabric, double relaxation) {
  const double coupled = narrowing_of_grid(fabric) * fabric.shear;
  return (relaxation * (fabric.stretch_warp - coupled) + 2 * coupled * fabric.shear_damping) /
         (fabric.stretch_warp + coupled);
}

double least_stretch_damping_on_grid(const FabricDef& fabric, double cell_u, double cell_v) {
  const DiagonalShares share = shares_of_diagonals(fabric, cell_u, cell_v);
  const auto part = [](double diagonals, double stiffness) {
    return stiffness > 0 ? diagonals / stiffness : 0;
  };
  return fabric.shear_damping *
         std::max(part(share.warp, fabric.stretch_warp), part(share.weft, fabric.stretch_weft));
}

double shortest_decay_time(double omega) {
  assert(omega > 0);
  return 1 / omega;
}

bool creeps(double omega, double relaxation) {
  return omega * relaxation > 2;
}

double decay_time(double omega, double relaxation) {
  assert(omega > 0 && relaxation > 0);
  if (!creeps(omega, relaxation)) return 2 / (omega * omega * relaxation);
  return relaxation / 2 + std::sqrt(relaxation * relaxation / 4 - 1 / (omega * omega));
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
