#include "tests/bench/shaking.h"

#include <algorithm>

#include "core/world/world.h"
#include "tests/bench/cases.h"
#include "tests/bench/measures.h"
#include "tests/support/disturbances.h"

namespace weft::bench {
namespace {

constexpr int kTicks = 300;
constexpr double kAllowed = 0.01;

/// @param rigidity  of bending, along warp and weft [N m]
WorldDef hung(int n, FabricDef fabric, double rigidity) {
  fabric.bending_warp = fabric.bending_weft = rigidity;
  WorldDef def = bench_scenes().front().make(n, fabric);
  def.cloths[0].v = -Vec3d::UnitY();
  def.environment.damping = 5;
  return def;
}

/// Runs and counts the ticks that were taken back.
int run(World<float>& world, int ticks) {
  int rescues = 0;
  for (int k = 0; k < ticks; ++k) rescues += world.step().divergence ? 1 : 0;
  return rescues;
}

/// What the energy rose above that of the start and the disturbance's work, over what was brought.
/// @param least  energy of the rest [J]
double gained(World<float>& world, test::Disturbance kind, unsigned seed, double least,
              int& rescues) {
  rescues += run(world, 60);
  const test::DisturbanceEffect effect = test::disturb(world, kind, seed);
  rescues += effect.rescues;
  const double brought = effect.before + effect.work - least;
  double highest = std::max(effect.excess, test::energy_of(world) - least - brought);
  for (int k = 0; k < kTicks; ++k) {
    rescues += run(world, 1);
    const double above = test::energy_of(world) - least - brought;
    if (!(above <= highest)) highest = above;
  }
  return std::max(highest, 0.0) / brought;
}

/// One solver, cloth and disturbance, with all its seeds.
ShakingFigure shake(const WorldDef& def, test::Disturbance disturbance, const World<float>& rest) {
  ShakingFigure figure;
  figure.disturbance = name_of(disturbance);
  figure.substeps = rest.report().substeps;
  figure.seeds = static_cast<int>(test::seeds_of(disturbance));
  const double least = test::energy_of(rest);
  for (unsigned seed = 20; seed < 20 + test::seeds_of(disturbance); ++seed) {
    World<float> damped(def);
    figure.rescues += run(damped, 60) + test::disturb(damped, disturbance, seed).rescues;
    figure.rescues += run(damped, kTicks);
    const double off = rms_distance(snapshot(damped.state()), snapshot(rest.state()));
    figure.from_rest = std::max(figure.from_rest, off);
    figure.back += off <= kAllowed ? 1 : 0;
    WorldDef free = def;
    free.environment.damping = 0;
    World<float> undamped(free);
    const double more = gained(undamped, disturbance, seed, least, figure.rescues);
    figure.gained_energy = std::max(figure.gained_energy, more);
    figure.bounded += more <= kAllowed ? 1 : 0;
  }
  return figure;
}

}  // namespace

std::vector<ShakingFigure> measure_shaking(bool quick) {
  const std::vector<Setting> solvers = {{"verlet", "x1", 1, 1, 1, 1},
                                        {"implicit", "1x2", 1, 1, 1, 2},
                                        {"xpbd", "32x2", 1, 1, 32, 2},
                                        {"relaxation", "1x2", 1, 1, 1, 2}};
  const std::vector<int> sizes = quick ? std::vector<int>{17} : std::vector<int>{33, 64};
  std::vector<ShakingFigure> figures;
  for (const int n : sizes) {
    for (std::size_t f = 0; f < 2; ++f) {
      const BenchFabric& fabric = bench_fabrics()[f];
      const double structural = fabric.fabric.stretch_warp - fabric.fabric.shear;
      std::vector<double> rigidities = {1e-5 * structural};
      if (n == sizes.front()) rigidities.push_back(fabric.fabric.bending_warp);
      for (const double rigidity : rigidities) {
        for (const Setting& setting : solvers) {
          const WorldDef def = with_setting(hung(n, fabric.fabric, rigidity), setting, 1);
          World<float> rest(def);
          run(rest, kTicks + 60);
          for (const test::Disturbance disturbance : test::kDisturbances) {
            ShakingFigure figure = shake(def, disturbance, rest);
            figure.solver = setting.solver;
            figure.sweeps = setting.sweeps;
            figure.fabric = fabric.name;
            figure.rigidity = rigidity;
            figure.n = n;
            figures.push_back(figure);
          }
        }
      }
    }
  }
  return figures;
}

}  // namespace weft::bench
