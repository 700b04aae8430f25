// Compares the damping that a mesh needs with that of its fabric.

#include "core/world/mesh_damping.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/cloth/grid_springs.h"
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

/// The longer relaxation time of stretch that a grid gives one of its threads, if its diagonals
/// make it longer than asked for; else 0 [s].
/// @param least  that stability needs [s]
double stretch_by_diagonals(const ClothDef& cloth, const FabricDef& fabric, double least) {
  if (cloth.mesh || cloth.direct_springs) return 0;
  const double cell_u = cloth.width / (cloth.columns - 1), cell_v = cloth.height / (cloth.rows - 1),
               ratio2 = cell_u * cell_u / (cell_v * cell_v);
  const SpringTimes times = grid_spring_times(fabric, cell_u, cell_v, least);
  const auto whole = [&](double stiffness, double diagonals, double time) {
    if (!(stiffness > 0)) return 0.0;
    return (time * std::max(stiffness - diagonals, 0.0) + times.shear * diagonals) / stiffness;
  };
  const double longer = std::max(whole(fabric.stretch_warp, fabric.shear * ratio2, times.warp),
                                 whole(fabric.stretch_weft, fabric.shear / ratio2, times.weft));
  constexpr double kRounding = 1e-9;
  return longer > std::max(fabric.stretch_damping, least) * (1 + kRounding) ? longer : 0;
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
    damping.of_shear = stretch_by_diagonals(world.def().cloths[k], fabric, least);
    damping.own = std::max(fabric.stretch_damping, least);
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
    if (damping.given == 0 && damping.of_shear == 0 && damping.substeps <= damping.undamped)
      continue;
    damping.cloth = cloth_name(world.def(), static_cast<Index>(k));
    found.push_back(damping);
  }
  return found;
}

std::string describe(const MeshDamping& damping) {
  std::string text;
  const auto say = [&text](const std::string& what) {
    text += (text.empty() ? "" : "; and ") + what;
  };
  if (damping.given > 0)
    say("its fabric damps with a relaxation time of " + number(damping.asked) +
        " s, and stability needs " + number(damping.given) +
        " s on this mesh: the first stretch wave loses at least " + number(100 * damping.loss) +
        " % of its energy a second; a finer mesh needs less");
  if (damping.of_shear > 0)
    say("the diagonals of its grid, damped by shear_damping, damp stretch along a thread with " +
        number(damping.of_shear) + " s in place of " + number(damping.own) +
        " s; a mesh damps both as they are set");
  if (damping.substeps > damping.undamped)
    say("its damping takes " + std::to_string(damping.substeps) + " substeps a tick in place of " +
        std::to_string(damping.undamped));
  return damping.cloth + ": " + text;
}

template std::vector<MeshDamping> damping_of_meshes(const World<float>&);
template std::vector<MeshDamping> damping_of_meshes(const World<double>&);

}  // namespace weft
