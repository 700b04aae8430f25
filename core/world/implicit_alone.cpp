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
double most_substeps(std::size_t particles) {
  assert(particles > 0);
  return std::min<double>(kMostSubsteps,
                          std::floor(kMostTickUpdates / static_cast<double>(particles)));
}

}  // namespace

bool is_beyond_verlet(std::size_t particles, int substeps) {
  return substeps > most_substeps(particles);
}

template <class Real>
bool steps_implicit_alone(const World<Real>& world) {
  const TickCost cost = world.cost_of(SolverKind::verlet, world.environment());
  return solver_of(world.def()) == SolverKind::implicit &&
         is_beyond_verlet(world.model().mass.size(), static_cast<int>(cost.substeps));
}

template <class Real>
std::string describe_implicit_alone(const World<Real>& world) {
  assert(steps_implicit_alone(world));
  const auto most = static_cast<long>(most_substeps(world.model().mass.size()));
  return "this cloth is too stiff or too strongly damped for verlet, which would step the ticks in "
         "which it touches something, or a pin moves, with at most " +
         std::to_string(most) +
         " substeps; implicit steps them alone, and such cloth is strained and shaken by them";
}

WEFT_INSTANTIATE_FUNCTIONS(steps_implicit_alone, describe_implicit_alone)

}  // namespace weft
