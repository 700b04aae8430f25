// Sums the energies of a state.

#include "core/diagnostics/energies.h"

#include <cassert>

namespace weft {

template <class Real>
double kinetic_energy(const ClothModel<Real>& model, const ClothState<Real>& state) {
  double sum = 0;
  for (std::size_t i = 0; i < state.v.size(); ++i)
    sum += 0.5 * static_cast<double>(model.mass[i]) * static_cast<double>(state.v[i].squaredNorm());
  return sum;
}

template <class Real>
EnergyReading read_energies(const ClothModel<Real>& model, const ClothState<Real>& state,
                            const Vec3<Real>& gravity, const ElasticEnergy& elastic) {
  assert(state.x.size() == model.mass.size() && state.v.size() == model.mass.size());
  Energies e;
  e.stretch = elastic.stretch;
  e.bending = elastic.bending;
  e.kinetic = kinetic_energy(model, state);
  const Vec3d g = gravity.template cast<double>();
  for (std::size_t i = 0; i < state.x.size(); ++i)
    e.gravity -= static_cast<double>(model.mass[i]) * g.dot(state.x[i].template cast<double>());
  return {e, elastic.largest_strain};
}

template <class Real>
EnergyReading read_energies(const ClothModel<Real>& model, const ClothState<Real>& state,
                            const Vec3<Real>& gravity) {
  return read_energies(model, state, gravity, elastic_energy(model, state.x));
}

template double kinetic_energy(const ClothModel<float>&, const ClothState<float>&);
template double kinetic_energy(const ClothModel<double>&, const ClothState<double>&);
template EnergyReading read_energies(const ClothModel<float>&, const ClothState<float>&,
                                     const Vec3<float>&, const ElasticEnergy&);
template EnergyReading read_energies(const ClothModel<double>&, const ClothState<double>&,
                                     const Vec3<double>&, const ElasticEnergy&);
template EnergyReading read_energies(const ClothModel<float>&, const ClothState<float>&,
                                     const Vec3<float>&);
template EnergyReading read_energies(const ClothModel<double>&, const ClothState<double>&,
                                     const Vec3<double>&);

}  // namespace weft
