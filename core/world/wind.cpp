#include "core/world/wind.h"

#include <algorithm>

#include "core/forces/gust.h"

namespace weft {
namespace {

/// Without a mean wind the eddies still drift, or a gust would stand still for ever [m/s].
const Vec3d kDriftOfStillAir(0.31, 0.17, 0.23);

}  // namespace

template <class Real>
void sample_wind(const EnvironmentDef& environment, double time, const Vec3Array<Real>& x,
                 ParticleFields<Real>& wind) {
  const Vec3<Real> mean = environment.wind.cast<Real>();
  if (environment.gust_speed == 0) {
    std::fill(wind.x.begin(), wind.x.end(), mean[0]);
    std::fill(wind.y.begin(), wind.y.end(), mean[1]);
    std::fill(wind.z.begin(), wind.z.end(), mean[2]);
    return;
  }
  const auto speed = static_cast<Real>(environment.gust_speed);
  const Vec3d carried = (environment.wind + kDriftOfStillAir) * time;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3d eddy = (x[i].template cast<double>() - carried) / environment.gust_length;
    const Vec3<Real> here = mean + smooth_noise<Real>(eddy) * speed;
    wind.x[i] = here[0];
    wind.y[i] = here[1];
    wind.z[i] = here[2];
  }
}

template void sample_wind(const EnvironmentDef&, double, const Vec3Array<float>&,
                          ParticleFields<float>&);
template void sample_wind(const EnvironmentDef&, double, const Vec3Array<double>&,
                          ParticleFields<double>&);

}  // namespace weft
