#pragma once

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/forces/force_pass.h"
#include "core/types.h"

// Energies of a state.

namespace weft {

/// Energies at one instant [J].
struct Energies {
  double kinetic = 0;
  double stretch = 0;
  double bending = 0;
  double gravity = 0;  ///< -sum m g . x
  double mechanical() const { return kinetic + stretch + bending; }
  double total() const { return mechanical() + gravity; }
};

/// Energies, and the strain found in the same pass over the elements.
struct EnergyReading {
  Energies energies;
  double largest_strain = 0;  ///< see ElasticEnergy
};

/// Kinetic energy of the present state, summed in double [J].
template <class Real>
double kinetic_energy(const ClothModel<Real>& model, const ClothState<Real>& state);

/// Energies of the present state, summed in double. NaN propagates.
/// @param gravity  [m/s^2]
template <class Real>
EnergyReading read_energies(const ClothModel<Real>& model, const ClothState<Real>& state,
                            const Vec3<Real>& gravity);

/// The same with a known elastic part.
template <class Real>
EnergyReading read_energies(const ClothModel<Real>& model, const ClothState<Real>& state,
                            const Vec3<Real>& gravity, const ElasticEnergy& elastic);

extern template EnergyReading read_energies(const ClothModel<float>&, const ClothState<float>&,
                                            const Vec3<float>&);
extern template EnergyReading read_energies(const ClothModel<double>&, const ClothState<double>&,
                                            const Vec3<double>&);
extern template EnergyReading read_energies(const ClothModel<float>&, const ClothState<float>&,
                                            const Vec3<float>&, const ElasticEnergy&);
extern template EnergyReading read_energies(const ClothModel<double>&, const ClothState<double>&,
                                            const Vec3<double>&, const ElasticEnergy&);

}  // namespace weft
