// Returns what a certificate has stopped for one drift, less what pairs take from each other.

#include "core/contact/guard/stopped_particles.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/contact/guard/constants.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Takes the approach from one pair. @return by how much its normal velocity changed [m/s]
template <class Real>
Real meet(StoppedPair<Real>& pair, const std::vector<Real>& inverse_mass, Vec3Array<Real>& v) {
  Real approach = 0, mobility = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = at_index(pair.particle[k]);
    approach -= pair.weight[k] * pair.normal.dot(v[i]);
    mobility += pair.weight[k] * pair.weight[k] * inverse_mass[i];
  }
  if (!(approach > 0 && mobility > 0)) return 0;
  pair.pushed += approach / mobility;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto i = at_index(pair.particle[k]);
    v[i] += pair.normal * (pair.weight[k] * inverse_mass[i] * approach / mobility);
  }
  return approach;
}

}  // namespace

template <class Real>
StoppedParticles<Real> stopped_particles(std::size_t particles) {
  StoppedParticles<Real> stopped;
  stopped.place_of.assign(particles, kNone);
  stopped.in_a_row.assign(particles, {});
  return stopped;
}

template <class Real>
void note_stopped(Index particle, const Vec3<Real>& v, const Vec3<Real>& v_drift,
                  StoppedParticles<Real>& stopped) {
  assert(at_index(particle) < stopped.place_of.size());
  Index& place = stopped.place_of[at_index(particle)];
  if (place == kNone) {
    place = static_cast<Index>(stopped.list.size());
    stopped.list.push_back({particle, v, v_drift});
  }
  stopped.list[at_index(place)].v_drift = v_drift;
}

template <class Real>
void give_velocities_back(StoppedParticles<Real>& stopped, Vec3Array<Real>& v) {
  stopped.any = !stopped.list.empty();
  stopped.jammed.clear();
  ++stopped.step;
  for (const StoppedParticle<Real>& one : stopped.list) {
    const auto i = at_index(one.particle);
    StopsInARow& row = stopped.in_a_row[i];
    row.count = row.step + 1 == stopped.step ? row.count + 1 : 1;
    row.step = stopped.step;
    if (v[i] == one.v_drift && row.count <= kMostInARow) v[i] = one.v;
    stopped.place_of[i] = kNone;
  }
  stopped.list.clear();
  for (const StoppedPair<Real>& pair : stopped.pairs) {
    const auto is_jammed = [&stopped](Index k) {
      const StopsInARow& row = stopped.in_a_row[at_index(k)];
      return row.step == stopped.step && row.count > kMostInARow;
    };
    if (std::any_of(pair.particle.begin(), pair.particle.end(), is_jammed))
      stopped.jammed.push_back({pair.key, pair.particle[0]});
  }
}

template <class Real>
void keep_mean_velocity(const Vec3d& mean, ClothState<Real>& state) {
  Vec3d momentum = Vec3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < state.v.size(); ++i) {
    const double own = 1 / static_cast<double>(state.inverse_mass[i]);
    momentum += state.v[i].template cast<double>() * own;
    mass += own;
  }
  assert(mass > 0 && std::isfinite(mass) && "all particles are free");
  const Vec3<Real> lack = (mean - momentum / mass).template cast<Real>();
  for (Vec3<Real>& v : state.v) v += lack;
}

template <class Real>
void meet_at_planes(const std::vector<Real>& inverse_mass, StoppedParticles<Real>& stopped,
                    Vec3Array<Real>& v) {
  Real enough = 0;
  for (int round = 0; round < kMostMeetings; ++round) {
    Real largest = 0;
    for (StoppedPair<Real>& pair : stopped.pairs)
      largest = std::max(largest, meet(pair, inverse_mass, v));
    if (!(largest > enough)) break;
    if (round == 0) enough = largest * Real(kMeetingResidual);
  }
}

template <class Real>
void forget_stopped(StoppedParticles<Real>& stopped) {
  for (const StoppedParticle<Real>& one : stopped.list)
    stopped.place_of[at_index(one.particle)] = kNone;
  stopped.list.clear();
  stopped.pairs.clear();
  stopped.jammed.clear();
  stopped.any = false;
  stopped.step += 2;  // no row goes on
}

template <class Real>
void note_all_stopped(const Vec3Array<Real>& v, StoppedParticles<Real>& stopped) {
  assert(v.size() == stopped.place_of.size());
  for (std::size_t i = 0; i < v.size(); ++i)
    note_stopped<Real>(static_cast<Index>(i), v[i], Vec3<Real>::Zero(), stopped);
}

WEFT_INSTANTIATE_FUNCTIONS(forget_stopped, note_all_stopped, stopped_particles, note_stopped,
                           give_velocities_back, keep_mean_velocity, meet_at_planes)

}  // namespace weft
