// Tells which worlds of the solver `implicit` verlet cannot help.

#include "core/world/implicit_alone.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/instantiate.h"
#include "core/world/constants.h"
#include "core/world/cost.h"

namespace weft {
namespace {

/// Most substeps of verlet that a world may take.
template <class Real>
double most_substeps(const World<Real>& world) {
  const auto particles = static_cast<double>(world.model().mass.size());
  return std::min<double>(kMostSubsteps, std::floor(kMostTickUpdates / std::max(1.0, particles)));
}

template <class Real>
double needed_substeps(const World<Real>& world) {
  return world.cost_of(SolverKind::verlet, world.environment()).substeps;
}

}  // namespace

template <class Real>
bool steps_implicit_alone(const World<Real>& world) {
  return solver_of(world.def()) == SolverKind::implicit &&
         needed_substeps(world) > most_substeps(world);
}

template <class Real>
std::string describe_implicit_alone(const World<Real>& world) {
  assert(steps_implicit_alone(world));
  const auto most = static_cast<long>(most_substeps(world));
  return "this cloth is too stiff or too strongly damped for verlet, which would step the ticks in "
         "which it touches something, or a pin moves, with at most " +
         std::to_string(most) +
         " substeps; implicit steps them alone, and such cloth is strained and shaken by them";
}

#define WEFT_INSTANTIATE(Real)                            \
  template bool steps_implicit_alone(const World<Real>&); \
  template std::string describe_implicit_alone(const World<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
