#pragma once

#include <string>
#include <vector>

#include "core/world/world_def.h"

// What is measured: scenes times fabrics times resolutions times solvers times their settings.

namespace weft::bench {

/// At which instants a run is compared with its reference.
enum class Instants {
  all_the_way,  ///< at every sample, the worst counts
  at_the_end,   ///< where it has come to rest
};

/// A scene of the report. Resolution and fabric are free.
struct BenchScene {
  const char* name;
  const char* what;  ///< one sentence
  int ticks;         ///< horizon, at 60 a second
  int sample_every;  ///< ticks
  Instants instants;
  bool forces_alone;        ///< no contact and no air: an ordinary differential equation
  double run_budget;        ///< CPU seconds that one run may take up to 128 particles a side [s]
  double reference_budget;  ///< CPU seconds that the reference may take [s]
  WorldDef (*make)(int n, const FabricDef& fabric);
};

const std::vector<BenchScene>& bench_scenes();

/// CPU seconds that one run may take [s]: above 128 twice the scene's.
double run_budget(const BenchScene& scene, int n);

/// A fabric of the report.
struct BenchFabric {
  const char* name;
  FabricDef fabric;
};

/// The test cloths of 0.2 kg/m^2 with structural springs of 196 and 1962 N/m, and cotton.
const std::vector<BenchFabric>& bench_fabrics();

/// The dashpots along the springs are numerics of verlet, not of the cloth: a reference has none,
/// and what they change counts as verlet's error.
WorldDef without_dashpots(WorldDef def);

/// One way to run a solver.
struct Setting {
  std::string solver;      ///< verlet, xpbd or relaxation
  std::string name;        ///< e.g. "x1.5" (of the stable substeps) or "16x4" (substeps x sweeps)
  double factor = 1;       ///< of verlet's own count of substeps
  int damping_sweeps = 1;  ///< 0: no dashpots
  int substeps = 1, sweeps = 1;
};

/// All settings, those of one solver together, each a different one. Quick: every second one.
/// @param fewest  substeps a tick that the bending asks of XPBD and of the seed's relaxation: a
///                world takes as many where it is asked for fewer, so settings start there
std::vector<Setting> settings(bool quick, int fewest = 1);

/// Substeps that bending asks of XPBD and of the seed's relaxation [a tick].
int fewest_relaxing_substeps(const WorldDef& def);

/// Applies a setting.
/// @param stable_substeps  that verlet takes by itself
WorldDef with_setting(WorldDef def, const Setting& setting, int stable_substeps);

}  // namespace weft::bench
