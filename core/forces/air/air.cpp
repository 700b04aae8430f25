// Samples the air at the particles, and bounds its speed for substeps and sleep.

#include "core/forces/air/air.h"

#include <algorithm>
#include <cassert>

#include "core/forces/air/gust.h"
#include "core/forces/constants.h"

namespace weft {
namespace {

/// Mean wind and gusts.
template <class Real>
void sample_weather(const EnvironmentDef& environment, double time, const Vec3d& ahead,
                    const Vec3Array<Real>& x, Vec3Array<Real>& air) {
  const Vec3<Real> mean = environment.wind.cast<Real>();
  if (environment.gust_speed == 0) {
    std::fill(air.begin(), air.end(), mean);
    return;
  }
  assert(environment.gust_length > 0);
  const auto speed = static_cast<Real>(environment.gust_speed);
  const Vec3d carried = (environment.wind + Vec3d(kDriftOfStillAir.data())) * time + ahead;
  SmoothNoise<Real> noise;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3d eddy = (x[i].template cast<double>() - carried) / environment.gust_length;
    air[i] = mean + noise.at(eddy) * speed;
  }
}

}  // namespace

bool is_calm(const EnvironmentDef& environment) {
  if (!(environment.air_density > 0)) return true;
  return !environment.still_air && fastest_air(environment) == 0;
}

bool changes_by_itself(const EnvironmentDef& environment) {
  return !is_calm(environment) && environment.gust_speed > 0;
}

double fastest_air(const EnvironmentDef& environment) {
  double fastest = environment.wind.norm() + kLongestNoise * environment.gust_speed;
  for (const FanDef& fan : environment.fans) fastest += fan.speed;
  return fastest;
}

double air_damping_rate(const EnvironmentDef& environment, const FabricDef& fabric,
                        double area_per_mass, double fastest_particle) {
  assert(fastest_particle >= 0 && area_per_mass > 0);
  if (is_calm(environment)) return 0;
  const double fastest = fastest_air(environment) + fastest_particle;
  return (environment.air_density * fabric.air_normal * fastest + fabric.air_tangential) *
         area_per_mass;
}

template <class Real>
std::size_t sample_air(const EnvironmentDef& environment, double time, const Vec3d& ahead,
                       const Vec3Array<Real>& x, Vec3Array<Real>& air) {
  assert(air.size() == x.size());
  sample_weather(environment, time, ahead, x, air);
  std::size_t evaluated = 0;
  for (const FanDef& fan : environment.fans) {
    if (fan.speed == 0) continue;
    const FanJet<Real> jet(fan);
    for (std::size_t i = 0; i < x.size(); ++i) air[i] += jet(x[i]);
    evaluated += x.size();
  }
  return evaluated;
}

template std::size_t sample_air(const EnvironmentDef&, double, const Vec3d&,
                                const Vec3Array<float>&, Vec3Array<float>&);
template std::size_t sample_air(const EnvironmentDef&, double, const Vec3d&,
                                const Vec3Array<double>&, Vec3Array<double>&);

}  // namespace weft
