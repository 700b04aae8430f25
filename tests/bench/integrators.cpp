#include "tests/bench/integrators.h"

#include <algorithm>
#include <stdexcept>

#include "core/forces/grid_pass.h"

namespace weft::bench {
namespace {

using Numbers = std::vector<double>;

/// The right-hand side x' = v, v' = f(x)/m + g - damping v, three numbers a particle, all 0 where
/// it is pinned.
class Motion {
 public:
  explicit Motion(World<double>& world)
      : damping_(world.environment().damping), position_(world.state().x),
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
      a[i] = f[i] * inverse_mass_[i] + (gravity_[i] - damping_ * v[i]);
  }

 private:
  double damping_;
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

Path extrapolate(const std::vector<Level>& levels, std::size_t first) {
  Path path = levels.back().path;
  for (Snapshot& s : path.samples) {
    std::fill(s.x.begin(), s.x.end(), Vec3d::Zero());
    std::fill(s.v.begin(), s.v.end(), Vec3d::Zero());
  }
  for (std::size_t i = first; i < levels.size(); ++i) {
    const double own = static_cast<double>(levels[i].substeps) * levels[i].substeps;
    double weight = 1;
    for (std::size_t j = first; j < levels.size(); ++j) {
      if (j != i)
        weight *= own / (own - static_cast<double>(levels[j].substeps) * levels[j].substeps);
    }
    for (std::size_t k = 0; k < path.samples.size(); ++k) {
      const Snapshot& s = levels[i].path.samples[k];
      for (std::size_t p = 0; p < s.x.size(); ++p) {
        path.samples[k].x[p] += weight * s.x[p];
        path.samples[k].v[p] += weight * s.v[p];
      }
    }
  }
  return path;
}

}  // namespace weft::bench
