// Estimates whether relaxation has enough substeps to hold a cloth's springs.

#include "core/world/spring_hold.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace weft {
namespace {

/// Side of the square represented by a particle of a part [m]: a grid's cell, about a mesh's edge.
template <class Real>
double spacing_of(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  assert(part.particles.count > 0 && part.fabric.areal_density > 0);
  double mass = 0;
  for (Index i = part.particles.first; i < part.particles.end(); ++i)
    mass += static_cast<double>(model.mass[static_cast<std::size_t>(i)]);
  return std::sqrt(mass / part.fabric.areal_density / part.particles.count);
}

/// Longest side of the bounding box of a part at rest [m].
template <class Real>
double extent_of(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  Vec3<Real> low = model.rest_positions[static_cast<std::size_t>(part.particles.first)];
  Vec3<Real> high = low;
  for (Index i = part.particles.first; i < part.particles.end(); ++i) {
    low = low.cwiseMin(model.rest_positions[static_cast<std::size_t>(i)]);
    high = high.cwiseMax(model.rest_positions[static_cast<std::size_t>(i)]);
  }
  return static_cast<double>((high - low).maxCoeff());
}

}  // namespace

double strain_of_hanging(double rows, double h, double gravity, double dt, int sweeps) {
  assert(rows >= 0 && h > 0 && dt > 0 && sweeps >= 1);
  return 3 * rows * gravity * dt * dt / (h * sweeps);
}

template <class Real>
std::vector<SlackSprings> slack_springs(const World<Real>& world) {
  std::vector<SlackSprings> found;
  const WorldDef& def = world.def();
  if (solver_of(def) != SolverKind::relaxation || !world.guard()) return found;
  const int substeps = static_cast<int>(world.cost_in(def.environment).substeps);
  for (std::size_t k = 0; k < world.model().parts.size(); ++k) {
    const ClothPart<Real>& part = world.model().parts[k];
    if (membrane_elements(part) == 0) continue;
    const double h = spacing_of(world.model(), part);
    SlackSprings slack;
    slack.substeps = substeps;
    slack.sweeps = sweeps_taken(def.relaxation);
    const bool one_sided = def.relaxation.compliance == 0 && slack.sweeps == 1;
    slack.needed_sweeps = one_sided ? 2 : slack.sweeps;
    slack.strain =
        strain_of_hanging(extent_of(world.model(), part) / h, h, def.environment.gravity.norm(),
                          world.tick_seconds() / substeps, slack.needed_sweeps);
    if (slack.strain <= kMostHangingStrain && !one_sided) continue;
    slack.cloth = cloth_name(def, static_cast<Index>(k));
    const double factor = std::max(1.0, std::sqrt(slack.strain / kMostHangingStrain));
    slack.needed = static_cast<int>(std::min<double>(kMostSubsteps, std::ceil(substeps * factor)));
    found.push_back(slack);
  }
  return found;
}

std::string describe(const SlackSprings& slack) {
  const auto count = [](int number, const std::string& what) {
    return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
  };
  return slack.cloth + ": " + count(slack.substeps, "substep") + " of " +
         count(slack.sweeps, "sweep") +
         " cannot hold its springs against gravity, which makes contact of cloth with cloth slow; "
         "it needs " +
         count(slack.needed, "substep") + " of " + count(slack.needed_sweeps, "sweep") +
         " (relaxation.substeps, relaxation.sweeps)";
}

template std::vector<SlackSprings> slack_springs(const World<float>&);
template std::vector<SlackSprings> slack_springs(const World<double>&);

}  // namespace weft
