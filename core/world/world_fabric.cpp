// Worlds made from a running one: a fork, and one whose cloth has another fabric.

#include <cassert>

#include "core/cloth/softening.h"
#include "core/error.h"
#include "core/world/model_of.h"
#include "core/world/world.h"
#include "core/world/wound_up.h"

namespace weft {

template <class Real>
std::unique_ptr<World<Real>> World<Real>::with_fabric(std::size_t cloth,
                                                      const FabricDef& fabric) const {
  assert(cloth < def_.cloths.size());
  std::unique_ptr<World> changed(new World(copy()));
  if (energy_) changed->measure_energy(true);  // a copy does not
  changed->take_fabric(cloth, fabric);
  changed->refuse_too_stiff();
  refuse_wound_up(model_, changed->model_, cloth, state_.x, cloth_field(cloth, "fabric"));
  return changed;
}

template <class Real>
std::unique_ptr<World<Real>> World<Real>::fork() const {
  std::unique_ptr<World> other(new World(copy()));
  other->energy_ = energy_;  // a copy has none
  other->allocate_external();
  return other;
}

/// Builds anew all that follows from masses, stiffness, thickness or friction. The topology stays,
/// and so do positions, velocities, pins and hands. Throws DefinitionError while the model is built
/// if the fabric does not suit it; this world is then unfit for use.
template <class Real>
void World<Real>::take_fabric(std::size_t cloth, const FabricDef& fabric) {
  assert(cloth < def_.cloths.size());
  def_.cloths[cloth].fabric = fabric;
  wake_all();  // before `sleep_` is built anew
  model_ = model_of<Real>(def_);
  soften(softness_, model_);
  assert(model_.mass.size() == state_.x.size());
  for (std::size_t i = 0; i < model_.mass.size(); ++i) {
    if (state_.inverse_mass[i] > 0) state_.inverse_mass[i] = Real(1) / model_.mass[i];
  }
  for (Grab<Real>& grab : grabs_.list) fit_hand(model_, grab);
  build_contact();
  renew_clamps();
  prepare_solver();
  accept_state();
  begin_balance();
}

#define WEFT_INSTANTIATE(Real)                                                                  \
  template std::unique_ptr<World<Real>> World<Real>::fork() const;                              \
  template std::unique_ptr<World<Real>> World<Real>::with_fabric(std::size_t, const FabricDef&) \
      const;                                                                                    \
  template void World<Real>::take_fabric(std::size_t, const FabricDef&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
