// Works of all causes, from velocities before and after each.

#include "core/solver/work_meter.h"

#include <algorithm>
#include <cassert>

#include "core/solver/verlet.h"

namespace weft {
namespace {

template <class Real>
Vec3d wide(const Vec3<Real>& v) {
  return v.template cast<double>();
}

/// What a force gives over what the velocity gets of it.
double force_ratio(const MeteredKick& kick) {
  return kick.seconds / kick.scaled_seconds;
}

/// Velocity of an object's point in the present substep [m/s].
template <class Real>
Vec3d surface_velocity(const ColliderFrame<Real>& frame, const Vec3d& point) {
  if (!frame.tracked || !frame.moves) return Vec3d::Zero();
  return wide(frame.velocity_at(point.template cast<Real>()));
}

}  // namespace

template <class Real>
WorkMeter<Real>::WorkMeter(std::size_t particles, std::size_t first_jaw) : first_jaw_(first_jaw) {
  for (Vec3Array<Real>* array :
       {&x_, &v_, &v_kicked_, &v_pulled_, &v_undriven_, &v_driven_, &sling_})
    array->assign(particles, Vec3<Real>::Zero());
  mean_.assign(particles, Vec3d::Zero());
  now_.corrected.assign(particles, Vec3d::Zero());
  kept_ = now_;
}

template <class Real>
void WorkMeter<Real>::begin_tick() {
  now_.flows = {};
  now_.seen_impulses = 0;
  std::fill(now_.corrected.begin(), now_.corrected.end(), Vec3d::Zero());
}

template <class Real>
void WorkMeter<Real>::begin(const ClothState<Real>& state) {
  assert(state.x.size() == mean_.size() && state.v.size() == mean_.size());
  x_ = state.x;
  v_ = state.v;
}

template <class Real>
void WorkMeter<Real>::kicked(const MeteredKick& kick, const MeteredForces<Real>& forces,
                             const Vec3Array<Real>& v) {
  assert(kick.seconds > 0 && kick.scaled_seconds > 0);
  kick_ = kick;
  forces_ = forces;
  v_kicked_ = v_pulled_ = v_driven_ = v;
}

template <class Real>
void WorkMeter<Real>::driven(const Vec3Array<Real>& v) {
  assert(v.size() == mean_.size());
  for (std::size_t i = 0; i < mean_.size(); ++i) v_driven_[i] += v[i] - v_undriven_[i];
}

template <class Real>
void WorkMeter<Real>::take_means(const Vec3Array<Real>& before, const Vec3Array<Real>& after) {
  for (std::size_t i = 0; i < mean_.size(); ++i) mean_[i] = (wide(before[i]) + wide(after[i])) / 2;
}

/// Air and slings. The work of the wind is that of its force on a surface with its own speed; what
/// the cloth does not get of it is lost in the air.
template <class Real>
void WorkMeter<Real>::measure_outer_forces() {
  if (!forces_.external || forces_.external->empty()) return;
  EnergyFlows& flows = now_.flows;
  const bool slung = forces_.grabs && !forces_.grabs->impulses.empty();
  if (slung) {
    std::fill(sling_.begin(), sling_.end(), Vec3<Real>::Zero());
    add_sling_forces(*forces_.grabs, sling_);
  }
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    Vec3d air = wide((*forces_.external)[i]);
    if (slung) {
      const Vec3d sling = wide(sling_[i]);
      flows.slings += sling.dot(mean_[i]) * kick_.seconds;
      air -= sling;
    }
    if (!forces_.around->air) continue;
    const Vec3d wind = wide(forces_.around->wind[i]);
    flows.wind += air.dot(wind) * kick_.seconds;
    flows.air += air.dot(wind - mean_[i]) * kick_.seconds;
  }
}

/// Drag, hands, pins and corrected positions. With r = seconds / scaled_seconds, with the constants
/// as they were rounded, all forces on a particle are m (v' - keep v) / scaled_seconds: what hands,
/// pins and contact give its velocity is r times as much of them, and drag has the rest of the
/// change, m ((1 - r) v' - (1 - r keep) v). A corrected position changes the potential energy by -f
/// times the correction, of which the forces at either end of the drift have half.
template <class Real>
void WorkMeter<Real>::measure_particle(std::size_t i, double mass, const ClothState<Real>& state,
                                       double drift) {
  EnergyFlows& flows = now_.flows;
  const Vec3d before = wide(v_[i]), kicked = wide(v_kicked_[i]), &mean = mean_[i];
  const double ratio = force_ratio(kick_);
  const Vec3d dragged = wide(state.v[i]) * (1 - ratio) - before * (1 - ratio * kick_.keep);
  flows.drag -= mass * dragged.dot(mean);
  flows.hands += mass * ratio * (wide(v_pulled_[i]) - kicked).dot(mean);
  flows.pins += mass * ratio * (wide(v_driven_[i]) - wide(v_pulled_[i])).dot(mean);
  const Vec3d corrected = wide(state.x[i]) - wide(x_[i]) - wide(state.v[i]) * drift;
  Vec3d force = (kicked - before * kick_.keep) * (mass / kick_.scaled_seconds);
  if (forces_.external && !forces_.external->empty()) force -= wide((*forces_.external)[i]);
  flows.push_out -= force.dot(corrected + now_.corrected[i]) / 2;
  now_.corrected[i] = corrected;
}

/// @returns energy that objects gave the cloth [J]
template <class Real>
double WorkMeter<Real>::measure_objects(const ClothState<Real>& state,
                                        const Contact<Real>& objects) {
  double given = 0;
  EnergyFlows& flows = now_.flows;
  objects.log().visit_from(now_.seen_impulses, [&](const ContactPoint& c, const Vec3d& impulse) {
    Vec3d point = Vec3d::Zero(), velocity = Vec3d::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(c.count); ++k) {
      const auto i = static_cast<std::size_t>(c.particle[k]);
      point += wide(state.x[i]) * c.weight[k];
      velocity += mean_[i] * c.weight[k];
    }
    const auto collider = static_cast<std::size_t>(c.collider);
    const Vec3d surface = surface_velocity(objects.frame(collider), point),
                over = velocity - surface;
    const double along = impulse.dot(c.normal) * over.dot(c.normal);
    (collider < first_jaw_ ? flows.objects : flows.grippers) += impulse.dot(surface);
    flows.impacts -= along;
    flows.friction -= impulse.dot(over) - along;
    given += impulse.dot(velocity);
  });
  return given;
}

/// Shares out the work of contact: what objects did not do, cloths did among themselves, or the
/// certificate of objects.
template <class Real>
void WorkMeter<Real>::share_contact(double work, const ClothState<Real>& state,
                                    const Contact<Real>* objects, bool cloths) {
  const double left = work - (objects ? measure_objects(state, *objects) : 0);
  (cloths ? now_.flows.self_contact : now_.flows.impacts) -= left;
}

template <class Real>
void WorkMeter<Real>::finish(const ClothModel<Real>& model, const ClothState<Real>& state,
                             const Contact<Real>* objects, bool cloths, double drift) {
  assert(drift >= 0 && state.x.size() == x_.size());
  take_means(v_, state.v);
  measure_outer_forces();
  double work = 0;
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    if (state.inverse_mass[i] == 0) continue;
    const auto mass = static_cast<double>(model.mass[i]);
    measure_particle(i, mass, state, drift);
    work += mass * (wide(state.v[i]) - wide(v_driven_[i])).dot(mean_[i]);
  }
  share_contact(work * force_ratio(kick_), state, objects, cloths);
  for (Vec3d& mean : mean_) mean *= kick_.seconds;  // now displacements
  now_.flows.damping +=
      dashpot_loss(model, x_, forces_.seen ? *forces_.seen : v_, mean_, forces_.dashpots);
}

template <class Real>
void WorkMeter<Real>::dragged(const ClothModel<Real>& model, const IndexRange& particles,
                              double keep, const Vec3Array<Real>& v) {
  assert(keep >= 0 && keep <= 1 && v.size() == v_.size());
  double sum = 0;
  for (Index k = particles.first; k < particles.end(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3d before = wide(v_[i]);
    sum += static_cast<double>(model.mass[i]) * before.dot(before + wide(v[i])) / 2;
  }
  now_.flows.drag += sum * (1 - keep);
}

template <class Real>
void WorkMeter<Real>::add_contact(const ClothModel<Real>& model, const ClothState<Real>& state,
                                  const Contact<Real>* objects, bool cloths) {
  take_means(v_pulled_, state.v);
  double work = 0;
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    const auto mass = static_cast<double>(model.mass[i]);
    const Vec3d driven = wide(v_driven_[i]);
    now_.flows.pins += mass * (driven - wide(v_pulled_[i])).dot(mean_[i]);
    work += mass * (wide(state.v[i]) - driven).dot(mean_[i]);
  }
  share_contact(work, state, objects, cloths);
}

template class WorkMeter<float>;
template class WorkMeter<double>;

}  // namespace weft
