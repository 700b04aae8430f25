#include "tests/bench/reference.h"

#include <algorithm>
#include <cmath>

#include "core/forces/grid_pass.h"
#include "tests/support/random.h"

namespace weft::bench {
namespace {

using Numbers = std::vector<double>;

/// The right-hand side x' = v, v' = f(x)/m + g - drag v, three numbers a particle, all 0 where it
/// is pinned.
class Motion {
 public:
  explicit Motion(World<double>& world)
      : drag_(world.environment().drag), position_(world.state().x),
        velocity_(world.state().x.size(), Vec3d::Zero()), force_(position_.size()) {
    grid_.prepare(world.model().parts[0]);
    if (!grid_.fits()) throw std::runtime_error("the reference wants a regular grid");
    for (const double w : world.state().inverse_mass) {
      for (int k = 0; k < 3; ++k) {
        inverse_mass_.push_back(w);
        gravity_.push_back(w > 0 ? world.environment().gravity[k] : 0);
      }
    }
  }

  std::size_t size() const { return gravity_.size(); }

  /// Without dashpots the springs do not ask for the velocities.
  void accelerations(const Numbers& x, const Numbers& v, Numbers& a) {
    std::copy(x.begin(), x.end(), position_.front().data());
    grid_.load(position_, velocity_);
    grid_.compute_internal_forces(force_);
    const double* f = force_.front().data();
    for (std::size_t i = 0; i < a.size(); ++i)
      a[i] = f[i] * inverse_mass_[i] + (gravity_[i] - drag_ * v[i]);
  }

 private:
  double drag_;
  GridPass<double> grid_;
  Vec3Array<double> position_, velocity_, force_;
  Numbers inverse_mass_, gravity_;
};

struct Stages {
  Numbers x, v, a, x_sum, v_sum;
  explicit Stages(std::size_t n) : x(n), v(n), a(n), x_sum(n), v_sum(n) {}
};

/// One step h of the classical method: slopes at t, t + h/2 twice and t + h, weighted 1 2 2 1.
void step_runge_kutta(Motion& motion, double h, Numbers& x, Numbers& v, Stages& s) {
  static constexpr double kWeight[] = {1, 2, 2, 1}, kNext[] = {0.5, 0.5, 1, 0};
  s.x = x;
  s.v = v;
  std::fill(s.x_sum.begin(), s.x_sum.end(), 0.0);
  std::fill(s.v_sum.begin(), s.v_sum.end(), 0.0);
  const std::size_t n = x.size();
  for (int k = 0; k < 4; ++k) {
    motion.accelerations(s.x, s.v, s.a);
    const double weight = kWeight[k], next = kNext[k] * h;
    for (std::size_t i = 0; i < n; ++i) {
      const double slope = s.v[i];
      s.x_sum[i] += weight * slope;
      s.v_sum[i] += weight * s.a[i];
      s.x[i] = x[i] + next * slope;
      s.v[i] = v[i] + next * s.a[i];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    x[i] += h / 6 * s.x_sum[i];
    v[i] += h / 6 * s.v_sum[i];
  }
}

void displace(World<double>& world, const Vec3Array<double>& offset) {
  for (std::size_t i = 0; i < offset.size(); ++i) {
    if (world.state().inverse_mass[i] > 0) world.state().x[i] += offset[i];
  }
  world.accept_state();
}

/// The last sample up to which the perturbation has grown less than it may.
std::size_t last_before_growth(const Path& path, const Path& perturbed, std::size_t first,
                               double& growth) {
  std::size_t last = 0;
  for (std::size_t k = 1; k < path.samples.size(); ++k) {
    const double grown = rms_distance(path.samples[k], perturbed.samples[k]) / kPerturbation;
    if (grown >= kMostGrowth) break;
    last = k;
    if (k >= first) growth = std::max(growth, grown);
  }
  return last;
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

}  // namespace

Path run_runge_kutta(const WorldDef& def, int ticks, int sample_every, int substeps,
                     const Vec3Array<double>& offset) {
  World<double> world(def);
  displace(world, offset);
  Motion motion(world);
  Stages stages(motion.size());
  const double* start = world.state().x.front().data();
  Numbers x(start, start + motion.size()), v(motion.size(), 0);
  Snapshot now = snapshot(world.state());
  Path path;
  path.samples.push_back(now);
  for (int tick = 1; tick <= ticks; ++tick) {
    for (int s = 0; s < substeps; ++s)
      step_runge_kutta(motion, world.tick_seconds() / substeps, x, v, stages);
    if (tick % sample_every != 0) continue;
    std::copy(x.begin(), x.end(), now.x.front().data());
    std::copy(v.begin(), v.end(), now.v.front().data());
    path.samples.push_back(now);
  }
  return path;
}

Path run_world(WorldDef def, int ticks, int sample_every, int substeps,
               const Vec3Array<double>& offset) {
  def.solver.min_substeps = substeps;
  def.solver.damping_sweeps = 2;
  World<double> world(def);
  displace(world, offset);
  Path path;
  path.samples.push_back(snapshot(world.state()));
  for (int tick = 1; tick <= ticks; ++tick) {
    const TickReport& report = world.step();
    if (report.divergence) throw std::runtime_error("reference: " + describe(*report.divergence));
    if (tick % sample_every == 0) path.samples.push_back(snapshot(world.state()));
  }
  return path;
}

Reference make_reference(const BenchScene& scene, const WorldDef& scene_def) {
  const WorldDef def = without_dashpots(scene_def);
  Reference reference;
  World<double> probe(def);
  int substeps = probe.step().substeps;
  // Leapfrog is stable up to dt = 2/omega, Runge-Kutta up to 2.78/omega.
  if (scene.forces_alone) substeps = (3 * substeps + 3) / 4;
  const auto run = [&](int ticks, int count, const Vec3Array<double>& offset) {
    const double start = cpu_seconds();
    Path path = scene.forces_alone ? run_runge_kutta(def, ticks, scene.sample_every, count, offset)
                                   : run_world(def, ticks, scene.sample_every, count, offset);
    reference.cpu_seconds += cpu_seconds() - start;
    return path;
  };
  const double start = cpu_seconds();
  run(2, substeps, {});
  // The first level, the perturbed run and one of twice the substeps.
  const double expected = 4 * (cpu_seconds() - start) * scene.ticks / 2;
  if (expected > scene.reference_budget) {
    reference.missing = "its reference would take " + std::to_string(std::lround(expected)) +
                        " CPU s, more than " + std::to_string(std::lround(scene.reference_budget));
    return reference;
  }
  reference.cpu_seconds = 0;
  reference.path = run(scene.ticks, substeps, {});
  const Path perturbed =
      run(scene.ticks, substeps, random_offset(reference.path.samples.front().x.size()));
  reference.mean_floor = mean_shape_error(perturbed, reference.path);
  const std::size_t end = reference.path.samples.size() - 1;
  reference.first = scene.compared == Compared::at_the_end ? end : 1;
  reference.last = last_before_growth(reference.path, perturbed, reference.first, reference.growth);
  reference.shortened = reference.last < end;
  if (reference.last < reference.first) {
    reference.missing = "a perturbation of 1 um has grown more than 10 times at the first sample";
    return reference;
  }
  for (double level_cost = reference.cpu_seconds / 2;;) {
    substeps *= 2;
    level_cost *= 2;
    Path finer = run(scene.ticks, substeps, {});
    reference.self_error = position_error(reference.path, finer, reference.first, reference.last);
    reference.path = std::move(finer);
    if (reference.self_error < kSelfErrorWanted) break;
    if (reference.cpu_seconds + 2 * level_cost > scene.reference_budget) break;
  }
  reference.how = std::string(scene.forces_alone ? "Runge-Kutta 4" : "verlet, double") + ", " +
                  std::to_string(substeps) + " substeps a tick";
  return reference;
}

}  // namespace weft::bench
