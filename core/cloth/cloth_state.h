#pragma once

#include <cassert>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// The state of cloths: positions, velocities and inverse masses.

namespace weft {

/// The changing data of a cloth. At tick boundaries, positions and velocities belong to the same
/// instant.
template <class Real>
struct ClothState {
  Vec3Array<Real> x;               ///< positions [m]
  Vec3Array<Real> v;               ///< velocities [m/s]
  std::vector<Real> inverse_mass;  ///< [1/kg]; 0 for a pinned particle
  /// For each cloth 1 if it sleeps: sleeping cloths are not computed. Empty if none sleeps.
  std::vector<char> asleep;

  bool is_asleep(std::size_t part) const {
    assert(asleep.empty() || part < asleep.size());
    return !asleep.empty() && asleep[part] != 0;
  }
};

/// Not moving, where the model begins, with nothing pinned.
template <class Real>
ClothState<Real> initial_state(const ClothModel<Real>& model) {
  assert(model.start_positions.size() == model.mass.size());
  ClothState<Real> state;
  state.x = model.start_positions;
  state.v.assign(model.mass.size(), Vec3<Real>::Zero());
  state.inverse_mass.reserve(model.mass.size());
  for (const Real mass : model.mass) {
    assert(mass > 0);
    state.inverse_mass.push_back(Real(1) / mass);
  }
  return state;
}

}  // namespace weft
