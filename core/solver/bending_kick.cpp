// Kicks cloth by quadratic bending alone.

#include "core/solver/bending_kick.h"

#include <cassert>

#include "core/forces/force_pass.h"
#include "core/instantiate.h"

namespace weft {

template <class Real>
void kick_by_bending(const ClothModel<Real>& model, double seconds, Vec3Array<Real>& force,
                     ClothState<Real>& state) {
  assert(force.size() == state.v.size() && state.x.size() == state.v.size());
  for (const ClothPart<Real>& part : model.parts) {
    if (part.bending_time == 0) continue;
    const auto first = static_cast<std::size_t>(part.particles.first);
    const auto end = static_cast<std::size_t>(part.particles.end());
    for (std::size_t i = first; i < end; ++i) force[i].setZero();
    add_quadratic_bending_forces(part, state.x, force);
    for (std::size_t i = first; i < end; ++i)
      state.v[i] += force[i] * (state.inverse_mass[i] * static_cast<Real>(seconds));
  }
}

WEFT_INSTANTIATE_FUNCTIONS(kick_by_bending)

}  // namespace weft
