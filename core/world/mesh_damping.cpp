// Compares the damping that a mesh needs with that of its fabric.

#include "core/world/mesh_damping.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/cloth/stability_bound.h"

namespace weft {
namespace {

/// Extent of a part along the warp [m].
template <class Real>
double warp_length(const ClothModel<Real>& model, const IndexRange& particles) {
  Real low = model.material[static_cast<std::size_t>(particles.first)][0], high = low;
  for (Index i = particles.first; i < particles.end(); ++i) {
    low = std::min(low, model.material[static_cast<std::size_t>(i)][0]);
    high = std::max(high, model.material[static_cast<std::size_t>(i)][0]);
  }
  return static_cast<double>(high - low);
}

/// Part of its energy that the first stretch wave loses in a second.
template <class Real>
double loss_of_wave(const ClothModel<Real>& model, const ClothPart<Real>& part, double time) {
  const double wave = std::numbers::pi / warp_length(model, part.particles);
  const double omega2 = wave * wave * part.fabric.stretch_warp / part.fabric.areal_density;
  return 1 - std::exp(-time * omega2);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace

template <class Real>
std::vector<MeshDamping> damping_of_meshes(const World<Real>& world) {
  std::vector<MeshDamping> found;
  const SolverKind solver = solver_of(world.def());
  if (solver == SolverKind::relaxation) return found;
  for (std::size_t k = 0; k < world.model().parts.size(); ++k) {
    const ClothPart<Real>& part = world.model().parts[k];
    const FabricDef& fabric = part.fabric;
    const double least = least_relaxation_time(part);
    MeshDamping damping;
    for (const double time : {fabric.stretch_damping, fabric.shear_damping}) {
      if (time == 0 || !(least > time) || damping.given > 0) continue;
      damping.asked = time;
      damping.given = least;
      damping.loss = loss_of_wave(world.model(), part, least);
    }
    if (solver == SolverKind::verlet) {
      const FrequencyBounds& b = part.bounds;
      const double omega2 = b.membrane_omega2 + b.locking_omega2 + b.bending_omega2;
      const int fewest = world.def().solver.min_substeps;
      const auto substeps = [&](double rate) {
        return static_cast<int>(substeps_for({omega2, rate}, world.tick_seconds(), fewest));
      };
      damping.undamped = substeps(least * b.membrane_omega2);
      damping.substeps = substeps(b.membrane_damping_rate + b.bending_damping_rate);
    }
    if (damping.given == 0 && damping.substeps <= damping.undamped) continue;
    damping.cloth = cloth_name(world.def(), static_cast<Index>(k));
    found.push_back(damping);
  }
  return found;
}

std::string describe(const MeshDamping& damping) {
  std::string text = damping.cloth + ": ";
  if (damping.given > 0)
    text += "its fabric damps with a relaxation time of " + number(damping.asked) +
            " s, and stability needs " + number(damping.given) +
            " s on this mesh: the first stretch wave loses at least " + number(100 * damping.loss) +
            " % of its energy a second; a finer mesh needs less";
  if (damping.substeps <= damping.undamped) return text;
  return text + (damping.given > 0 ? "; and " : "") + "its damping takes " +
         std::to_string(damping.substeps) + " substeps a tick in place of " +
         std::to_string(damping.undamped);
}

template std::vector<MeshDamping> damping_of_meshes(const World<float>&);
template std::vector<MeshDamping> damping_of_meshes(const World<double>&);

}  // namespace weft
