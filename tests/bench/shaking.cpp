#include "tests/bench/shaking.h"

#include <cmath>

#include "core/world/world.h"
#include "tests/bench/cases.h"
#include "tests/bench/measures.h"
#include "tests/support/insults.h"

namespace weft::bench {
namespace {

constexpr int kTicks = 300;

/// The rigidity is such that the rest is unique, as in tests/laws/shaking.h: with one a hundred
/// times smaller a cloth that may pass through itself keeps tucks, and they are equilibria.
WorldDef hung(int n, const FabricDef& fabric, double drag) {
  WorldDef def = bench_scenes().front().make(n, fabric);
  FabricDef& stiffened = def.cloths[0].fabric;
  stiffened.bending_warp = stiffened.bending_weft =
      1e-5 * (stiffened.stretch_warp - stiffened.shear);
  def.cloths[0].v = -Vec3d::UnitY();
  def.environment.drag = drag;
  return def;
}

/// Runs and counts the ticks that were taken back.
int run(World<float>& world, int ticks) {
  int rescues = 0;
  for (int k = 0; k < ticks; ++k) rescues += world.step().divergence ? 1 : 0;
  return rescues;
}

/// Hurts a world after a second and lets it run; returns the ticks that were taken back.
/// @param least    energy of the rest [J]
/// @param highest  what the energy rose above that after the insult, over what the insult brought
int hurt(World<float>& world, test::Insult kind, int ticks, double least, double& highest) {
  int rescues = run(world, 60) + test::insult(world, kind);
  const double start = world.report().energies.total();
  highest = 0;
  for (int k = 0; k < ticks; ++k) {
    rescues += run(world, 1);
    const double gained = world.report().energies.total() - start;
    if (!(gained <= highest)) highest = gained;
  }
  highest /= start - least;
  return rescues;
}

}  // namespace

std::vector<ShakingFigure> measure_shaking(bool quick) {
  const std::vector<Setting> solvers = {{"verlet", "x1", 1, 1, 1, 1},
                                        {"xpbd", "32x1", 1, 1, 32, 1},
                                        {"relaxation", "1x2", 1, 1, 1, 2}};
  const std::vector<int> sizes = quick ? std::vector<int>{17} : std::vector<int>{33, 64};
  std::vector<ShakingFigure> figures;
  for (const int n : sizes) {
    for (std::size_t f = 0; f < 2; ++f) {
      const BenchFabric& fabric = bench_fabrics()[f];
      for (const Setting& setting : solvers) {
        const auto def = [&](double drag) {
          return with_setting(hung(n, fabric.fabric, drag), setting, 1);
        };
        World<float> rest(def(5));
        run(rest, kTicks + 60);
        const double least = rest.report().energies.total();
        for (const test::Insult insult : test::kInsults) {
          ShakingFigure figure{
              setting.solver, setting.name, fabric.name, name_of(insult), n, 0, 0, 0};
          double unused = 0;
          World<float> damped(def(5)), free(def(0));
          figure.rescues += hurt(damped, insult, kTicks, least, unused);
          figure.from_rest = rms_distance(snapshot(damped.state()), snapshot(rest.state()));
          figure.rescues += hurt(free, insult, kTicks / 5, least, figure.gained_energy);
          figures.push_back(figure);
        }
      }
    }
  }
  return figures;
}

}  // namespace weft::bench
