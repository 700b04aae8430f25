#include "core/forces/air/wind.h"

#include <algorithm>

#include "core/forces/air/gust.h"

namespace weft {
namespace {

/// Without a mean wind the eddies still drift, or a gust would stand still for ever [m/s].
const Vec3d kDriftOfStillAir(0.31, 0.17, 0.23);

/// The wind that is everywhere.
template <class Real>
void sample_weather(const EnvironmentDef& environment, double time, const Vec3Array<Real>& x,
                    Vec3Array<Real>& wind) {
  const Vec3<Real> mean = environment.wind.cast<Real>();
  if (environment.gust_speed == 0) {
    std::fill(wind.begin(), wind.end(), mean);
    return;
  }
  const auto speed = static_cast<Real>(environment.gust_speed);
  const Vec3d carried = (environment.wind + kDriftOfStillAir) * time;
  SmoothNoise<Real> noise;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3d eddy = (x[i].template cast<double>() - carried) / environment.gust_length;
    wind[i] = mean + noise.at(eddy) * speed;
  }
}

}  // namespace

template <class Real>
std::size_t sample_wind(const EnvironmentDef& environment, double time, const Vec3Array<Real>& x,
                        Vec3Array<Real>& wind) {
  sample_weather(environment, time, x, wind);
  std::size_t evaluated = 0;
  for (const FanDef& fan : environment.fans) {
    if (fan.speed == 0) continue;
    const FanJet<Real> jet(fan);
    for (std::size_t i = 0; i < x.size(); ++i) wind[i] += jet(x[i]);
    evaluated += x.size();
  }
  return evaluated;
}

template std::size_t sample_wind(const EnvironmentDef&, double, const Vec3Array<float>&,
                                 Vec3Array<float>&);
template std::size_t sample_wind(const EnvironmentDef&, double, const Vec3Array<double>&,
                                 Vec3Array<double>&);

}  // namespace weft
