#include "tests/bench/reference.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/world/world.h"
#include "tests/support/random.h"

namespace weft::bench {
namespace {

/// Above so many CPU seconds extrapolation, which takes a quarter of it, is the reference.
constexpr double kRungeKuttaBudget = 12;

/// What a refinement is made of: runs of one integrator, and how they become a path.
struct Method {
  const BenchScene& scene;
  const WorldDef& def;
  bool runge_kutta = false, extrapolated = false;
  int stable = 0;  ///< substeps a tick of the coarsest level
  double seconds = 0;

  Path run(int ticks, int substeps, const Vec3Array<double>& offset) {
    const double start = cpu_seconds();
    Path path = runge_kutta ? run_runge_kutta(def, ticks, scene.sample_every, substeps, offset)
                            : run_world(def, ticks, scene.sample_every, substeps, offset);
    seconds += cpu_seconds() - start;
    return path;
  }

  int substeps(std::size_t level) const {
    static constexpr double kFactors[] = {1, 1.25, 1.5, 2, 3};
    const double factor = extrapolated ? kFactors[level] : std::exp2(static_cast<double>(level));
    return static_cast<int>(std::ceil(factor * stable));
  }
  std::size_t most_levels() const { return extrapolated ? 5 : 8; }

  std::string name(int substeps) const {
    const std::string count = std::to_string(substeps) + " substeps a tick";
    if (runge_kutta) return "Runge-Kutta 4, " + count;
    return (extrapolated ? "verlet, double, extrapolated from at most " : "verlet, double, ") +
           count;
  }
};

/// The last sample until which noise stays below a bound; before `first` if it never does.
std::size_t last_below(const std::vector<ErrorVector>& noise, double ErrorVector::*quantity,
                       double bound, std::size_t first) {
  std::size_t k = first;
  while (k < noise.size() && noise[k].*quantity < bound) ++k;
  return k - 1;
}

Vec3Array<double> random_offset(std::size_t n) {
  test::Random random(17);
  Vec3Array<double> offset(n);
  double sum = 0;
  for (Vec3d& d : offset) {
    for (int k = 0; k < 3; ++k) d[k] = random.uniform(-1, 1);
    sum += d.squaredNorm();
  }
  for (Vec3d& d : offset) d *= kPerturbation / std::sqrt(sum / static_cast<double>(n));
  return offset;
}

/// Refines from the coarsest level on.
void refine(Method& method, Path coarsest, Reference& reference) {
  std::vector<Level> levels;
  levels.push_back({method.stable, coarsest});
  reference.path = std::move(coarsest);
  const double unit = method.seconds / 2 / method.stable;  // a substep a tick, of two runs
  for (std::size_t level = 1; level < method.most_levels(); ++level) {
    const int substeps = method.substeps(level);
    const bool least = level <= (method.extrapolated ? 2u : 1u);
    if (!least && method.seconds + unit * substeps > method.scene.reference_budget) break;
    levels.push_back({substeps, method.run(method.scene.ticks, substeps, {})});
    Path finer = method.extrapolated ? extrapolate(levels, 0) : levels.back().path;
    // An extrapolation is compared with the one that lacks the coarsest level.
    const Path other = method.extrapolated ? extrapolate(levels, 1) : reference.path;
    reference.self_error =
        position_error(other, finer, reference.compared.first, reference.compared.positions);
    reference.path = std::move(finer);
    if (!method.extrapolated) levels.erase(levels.begin());
    reference.how = method.name(substeps);
    if (reference.self_error < kSelfErrorWanted && !(method.extrapolated && level < 2)) break;
  }
}

/// Takes the first method that fits the budget; if none does, says so.
/// @returns whether there is one
bool choose(Method& method, ReferenceMethod wanted, Reference& reference) {
  World<double> probe(method.def);
  const int leapfrog = probe.step().substeps;
  const double start = cpu_seconds();
  probe.step();
  const double tick = cpu_seconds() - start, budget = method.scene.reference_budget;
  const auto fits = [&](double runs, double seconds_a_tick, double most) {
    const double expected = runs * seconds_a_tick * method.scene.ticks;
    char text[96];
    std::snprintf(text, sizeof text, "its reference would take %.3g CPU s, more than %.3g",
                  expected, most);
    reference.missing = expected <= most ? "" : text;
    return expected <= most;
  };
  method.stable = leapfrog;
  // The coarsest level, the perturbed run and one of twice the substeps.
  if (!method.scene.forces_alone) return fits(4, tick, budget);
  // Leapfrog is stable up to dt = 2/omega, Runge-Kutta up to 2.78/omega, in four stages.
  const double runge_kutta_budget = std::min(kRungeKuttaBudget, budget);
  if (wanted != ReferenceMethod::extrapolation && fits(4, 3 * tick, runge_kutta_budget)) {
    method.runge_kutta = true;
    method.stable = (3 * leapfrog + 3) / 4;
    return true;
  }
  method.extrapolated = true;  // the coarsest level twice, 1.25 and 1.5 times as many substeps
  return wanted != ReferenceMethod::runge_kutta && fits(4.75, tick, budget);
}

}  // namespace

Reference make_reference(const BenchScene& scene, const WorldDef& scene_def,
                         ReferenceMethod wanted) {
  const WorldDef def = without_dashpots(scene_def);
  Reference reference;
  Method method{scene, def};
  if (!choose(method, wanted, reference)) return reference;
  reference.missing.clear();
  Path path = method.run(scene.ticks, method.stable, {});
  const Path perturbed =
      method.run(scene.ticks, method.stable, random_offset(path.samples.front().x.size()));
  const World<double> world(def);
  const std::vector<ErrorVector> noise =
      errors(world.model(), def.cloths[0], def.environment.gravity, perturbed, path);
  Compared& compared = reference.compared;
  compared.first = scene.instants == Instants::at_the_end ? noise.size() - 1 : 1;
  compared.positions = last_below(noise, &ErrorVector::position, kMostNoise, compared.first);
  compared.strains = last_below(noise, &ErrorVector::strain, kMostNoiseOfStrain, compared.first);
  compared.energies = last_below(noise, &ErrorVector::energy, kMostNoise, compared.first);
  if (method.extrapolated) {  // runs that have parted have no limit, nor has their energy
    compared.strains = std::min(compared.strains, compared.positions);
    compared.energies = std::min(compared.energies, compared.positions);
  }
  reference.noise = worst_error(noise, compared, perturbed, path);
  if (compared.positions < compared.first)
    reference.missing = "1 um at the start changes positions too much at the first sample";
  else
    refine(method, std::move(path), reference);
  reference.cpu_seconds = method.seconds;
  return reference;
}

}  // namespace weft::bench
