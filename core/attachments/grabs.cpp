// Forces, limits and bookkeeping of hands and slings.

#include "core/attachments/grabs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/attachments/hand_disc.h"
#include "core/error.h"

namespace weft {
namespace {

const FieldInfo kTargetInfo{"target", kPositionRange, "m", "target of the held point"};

void validate(const GrabDef& def, std::size_t triangles) {
  check_field("drag.", {"triangle", 0, static_cast<double>(triangles) - 1, "", "a triangle"},
              def.triangle);
  double sum = 0;
  for (const double w : def.barycentric) {
    check_field("drag.", {"barycentric", 0, 1, "", "weights of the corners"}, w);
    sum += w;
  }
  check_field("drag.", {"barycentric", 0.999, 1.001, "as their sum", "weights of the corners"},
              sum);
  check_field("drag.", {"radius", kRadiusRange, "m", "radius of the held disc"}, def.radius);
  check_field("drag.", {"stiffness", kStiffnessRange, "N/m", "stiffness of the hand"},
              def.stiffness);
  check_field("drag.", {"max_force", kForceRange, "N", "largest force of the hand"}, def.max_force);
  check_field("drag.", kTargetInfo, def.target);
}

template <class Real>
Vec3<Real> weighted_mean(const Grab<Real>& grab, const Vec3Array<Real>& values) {
  assert(grab.weights.size() == grab.particles.size());
  Vec3<Real> sum = Vec3<Real>::Zero();
  for (std::size_t n = 0; n < grab.particles.size(); ++n)
    sum += values[static_cast<std::size_t>(grab.particles[n])] * grab.weights[n];
  return sum;
}

/// Inverse of the effective mass at the hand: sum w^2 / m [1/kg].
template <class Real>
double inverse_held_mass(const ClothModel<Real>& model, const Grab<Real>& grab) {
  double sum = 0;
  for (std::size_t n = 0; n < grab.particles.size(); ++n) {
    const auto w = static_cast<double>(grab.weights[n]);
    sum += w * w / static_cast<double>(model.mass[static_cast<std::size_t>(grab.particles[n])]);
  }
  return sum;
}

template <class Real>
auto find(GrabId id, Grabs<Real>& grabs) {
  return std::find_if(grabs.list.begin(), grabs.list.end(),
                      [id](const Grab<Real>& grab) { return grab.id == id; });
}

template <class Real>
Vec3<Real> bounded(const Vec3<Real>& force, double limit) {
  assert(limit >= 0);
  const Real size = force.norm(), most = static_cast<Real>(limit);
  return size > most ? Vec3<Real>(force * (most / size)) : force;
}

/// The point between `from` and `to` that is at most `reach` from `from` [m].
template <class Real>
Vec3<Real> within_reach(const Vec3<Real>& from, const Vec3<Real>& to, double reach) {
  assert(reach > 0);
  const Vec3d offset = (to - from).template cast<double>();
  const double length = offset.norm();
  if (length <= reach) return to;
  return from + Vec3<Real>((offset * (reach / length)).template cast<Real>());
}

/// Force of the sling if it were fired now [N].
template <class Real>
Vec3<Real> sling_force(const Grab<Real>& grab, const ClothState<Real>& state) {
  const Vec3<Real> pull = grab.target - held_point(grab, state.x);
  return bounded<Real>(pull * static_cast<Real>(grab.def.stiffness), grab.def.max_force);
}

/// Velocity change of the held point per unit impulse there [1/kg].
template <class Real>
Real mobility(const Grab<Real>& grab, const ClothState<Real>& state) {
  Real sum = 0;
  for (std::size_t n = 0; n < grab.particles.size(); ++n)
    sum += grab.weights[n] * grab.weights[n] *
           state.inverse_mass[static_cast<std::size_t>(grab.particles[n])];
  return sum;
}

/// The damped spring of a live hand, solved together with the velocity that it produces. Backward
/// Euler in the spring alone: with explicit cloth forces it is stable wherever these are, for any
/// stiffness, and it includes the bound of the force (a spring that yields is convex too). A
/// resting particle stays at rest, because the hand exactly cancels the kick of the other forces.
/// Hands that hold the same particles solve in turn, each with the others' latest forces.
/// @param velocity  of the held point after all other forces [m/s]
/// @param seconds   duration of the force
template <class Real>
Vec3<Real> hand_force(const Grab<Real>& grab, const HandStep<Real>& step, Real seconds,
                      const Vec3Array<Real>& x, const Vec3<Real>& velocity, Real mobility) {
  assert(step.dt > 0 && step.rate > 0 && seconds > 0);
  assert(step.progress >= 0 && step.progress <= 1);
  const auto stiffness = static_cast<Real>(grab.def.stiffness);
  const Vec3<Real> path = grab.path_end - grab.path_begin;
  const Vec3<Real> target = grab.path_begin + path * step.progress;
  const Vec3<Real> approach = path * step.rate - velocity;
  const Vec3<Real> pull =
      (target - held_point(grab, x) + approach * step.dt) * stiffness - velocity * grab.damping;
  const Real resistance = (grab.damping + stiffness * step.dt) * seconds * mobility;
  return bounded<Real>(pull / (1 + resistance), grab.def.max_force);
}

/// Stores the impulses that a force gives the held particles in `seconds` [N s].
template <class Real>
void note_impulses(const Vec3<Real>& force, Real seconds, Grab<Real>& grab) {
  assert(grab.impulse.size() == grab.particles.size());
  grab.given += force.template cast<double>() * static_cast<double>(seconds);
  for (std::size_t n = 0; n < grab.particles.size(); ++n)
    grab.impulse[n] = force * (grab.weights[n] * seconds);
}

/// Applies a force to the held particles for `seconds`.
template <class Real>
void pull(const Grab<Real>& grab, const Vec3<Real>& force, Real seconds, ClothState<Real>& state) {
  for (std::size_t n = 0; n < grab.particles.size(); ++n) {
    const auto i = static_cast<std::size_t>(grab.particles[n]);
    state.v[i] += force * (grab.weights[n] * state.inverse_mass[i] * seconds);
  }
}

/// Calls visit(grab) for all live hands; updates the force of slings.
template <class Real, class Visit>
void for_live(Grabs<Real>& grabs, const ClothState<Real>& state, Visit&& visit) {
  for (Grab<Real>& grab : grabs.list) {
    if (grab.def.mode == GrabMode::live)
      visit(grab);
    else
      grab.force = sling_force(grab, state);
  }
}

/// Limits velocities to kFastestHeld, and subtracts the lost impulse from the force.
template <class Real>
void limit_speeds(Grab<Real>& grab, Real seconds, Real force_ratio, ClothState<Real>& state) {
  constexpr Real kMost = static_cast<Real>(kFastestHeld);
  for (std::size_t n = 0; n < grab.particles.size(); ++n) {
    const auto i = static_cast<std::size_t>(grab.particles[n]);
    Vec3<Real>& v = state.v[i];
    const Real inverse_mass = state.inverse_mass[i];
    const Real speed2 = v.squaredNorm();
    if (!(speed2 > kMost * kMost) || inverse_mass == 0) continue;
    const Vec3<Real> kept = v * (kMost / std::sqrt(speed2));
    const Vec3<Real> lost = (v - kept) / inverse_mass;
    grab.impulse[n] -= lost * force_ratio;
    grab.force -= lost / seconds;
    grab.given -= (lost * force_ratio).template cast<double>();
    v = kept;
  }
}

template <class Real>
void share_force(const std::vector<Index>& particles, const std::vector<Real>& weights,
                 const Vec3<Real>& shared, Vec3Array<Real>& force) {
  for (std::size_t n = 0; n < particles.size(); ++n)
    force[static_cast<std::size_t>(particles[n])] += shared * weights[n];
}

}  // namespace

template <class Real>
void fit_hand(const ClothModel<Real>& model, Grab<Real>& grab) {
  if (grab.def.mode != GrabMode::live) return;
  const double stiffness = grab.def.stiffness, per_mass = inverse_held_mass(model, grab);
  grab.damping = static_cast<Real>(2 * kGrabDampingRatio * std::sqrt(stiffness / per_mass));
  grab.bound = {stiffness * per_mass, static_cast<double>(grab.damping) * per_mass};
}

template <class Real>
GrabId add_grab(const ClothModel<Real>& model, const ClothState<Real>& state, const GrabDef& def,
                Grabs<Real>& grabs) {
  assert(state.x.size() == model.mass.size());
  validate(def, model.triangles.size());
  if (!has_capacity(grabs))
    throw DefinitionError("drag", std::to_string(kMostGrabs + 1),
                          "at most " + std::to_string(kMostGrabs) + " at once",
                          "release one first");
  Grab<Real> grab;
  grab.id = grabs.next_id++;
  grab.def = def;
  weigh_hold(model, def, grab);
  for (Vec3Array<Real>* array : {&grab.impulse, &grab.velocity})
    array->assign(grab.particles.size(), Vec3<Real>::Zero());
  Vec3<Real> hit = Vec3<Real>::Zero();
  const Triangle& corners = model.triangles[static_cast<std::size_t>(def.triangle)];
  for (std::size_t k = 0; k < 3; ++k)
    hit += state.x[static_cast<std::size_t>(corners[k])] * static_cast<Real>(def.barycentric[k]);
  grab.offset = hit - weighted_mean(grab, state.x);
  grab.target = def.target.cast<Real>();
  grab.path_begin = grab.path_end = hit;
  fit_hand(model, grab);
  return grabs.list.emplace_back(std::move(grab)).id;
}

template <class Real>
bool move_grab(GrabId id, const Vec3d& target, Grabs<Real>& grabs) {
  const auto found = find(id, grabs);
  if (found == grabs.list.end()) return false;
  check_field("drag.", kTargetInfo, target);
  found->def.target = target;
  found->target = target.cast<Real>();
  return true;
}

template <class Real>
bool remove_grab(GrabId id, Grabs<Real>& grabs) {
  const auto found = find(id, grabs);
  if (found == grabs.list.end()) return false;
  grabs.list.erase(found);
  return true;
}

template <class Real>
std::optional<Vec3<Real>> fire_sling(GrabId id, int ticks, const ClothState<Real>& state,
                                     Grabs<Real>& grabs) {
  assert(ticks >= 1);
  const auto found = find(id, grabs);
  if (found == grabs.list.end() || found->def.mode != GrabMode::sling) return std::nullopt;
  const Vec3<Real> force = sling_force(*found, state);
  grabs.impulses.push_back({std::move(found->particles), std::move(found->weights), force, ticks});
  grabs.list.erase(found);
  return force;
}

template <class Real>
void lead_hands(double tick_seconds, const Vec3Array<Real>& x, Grabs<Real>& grabs) {
  assert(tick_seconds > 0);
  const double lead = kFastestHeld * std::max(tick_seconds, kLeadSeconds);
  for (Grab<Real>& grab : grabs.list) {
    if (grab.def.mode != GrabMode::live) continue;
    const Vec3<Real> held = held_point(grab, x);
    grab.path_begin = within_reach<Real>(held, grab.path_begin, lead);
    grab.path_end = within_reach<Real>(held, grab.target, lead);
  }
}

template <class Real>
void finish_tick(double tick_seconds, Grabs<Real>& grabs) {
  assert(tick_seconds > 0);
  for (Grab<Real>& grab : grabs.list) {
    grab.path_begin = grab.path_end;
    grab.told = grab.def.mode == GrabMode::live ? (grab.given / tick_seconds).eval()
                                                : grab.force.template cast<double>().eval();
  }
  for (SlingImpulse<Real>& impulse : grabs.impulses) {
    assert(impulse.ticks_left > 0);
    --impulse.ticks_left;
  }
  std::erase_if(grabs.impulses,
                [](const SlingImpulse<Real>& impulse) { return impulse.ticks_left <= 0; });
}

template <class Real>
Vec3<Real> held_point(const Grab<Real>& grab, const Vec3Array<Real>& x) {
  return weighted_mean(grab, x) + grab.offset;
}

template <class Real>
void pull_by_hand(const HandStep<Real>& step, Real seconds, Real force_ratio,
                  ClothState<Real>& state, Grabs<Real>& grabs) {
  for_live(grabs, state, [&](const Grab<Real>& grab) { pull(grab, grab.force, seconds, state); });
  for_live(grabs, state, [&](Grab<Real>& grab) {
    const Real own = mobility(grab, state);
    const Vec3<Real> others = weighted_mean(grab, state.v) - grab.force * (own * seconds);
    const Vec3<Real> force = hand_force(grab, step, seconds, state.x, others, own);
    pull<Real>(grab, force - grab.force, seconds, state);
    grab.force = force;
    note_impulses(force, seconds * force_ratio, grab);
  });
  for_live(grabs, state,
           [&](Grab<Real>& grab) { limit_speeds(grab, seconds, force_ratio, state); });
}

template <class Real>
void add_hand_forces(const HandStep<Real>& step, Real keep, const Vec3<Real>& gravity,
                     const ClothState<Real>& state, Grabs<Real>& grabs, Vec3Array<Real>& force) {
  assert(keep >= 0 && keep <= 1);
  assert(force.size() == state.x.size());
  for_live(grabs, state, [&](const Grab<Real>& grab) {
    share_force(grab.particles, grab.weights, grab.force, force);
  });
  for_live(grabs, state, [&](Grab<Real>& grab) {
    const Real own = mobility(grab, state);
    Vec3<Real> others = grab.force * (-own * step.dt);
    for (std::size_t n = 0; n < grab.particles.size(); ++n) {
      const auto i = static_cast<std::size_t>(grab.particles[n]);
      const Real w = state.inverse_mass[i];
      if (w == 0) continue;
      others += (state.v[i] * keep + (force[i] * w + gravity) * step.dt) * grab.weights[n];
    }
    const Vec3<Real> resisted = others + grab.resisted;
    const Vec3<Real> found = hand_force(grab, step, step.dt, state.x, resisted, own);
    share_force<Real>(grab.particles, grab.weights, found - grab.force, force);
    grab.unresisted = others + found * (own * step.dt);
    grab.force = found;
    note_impulses(found, step.dt, grab);
  });
}

template <class Real>
void note_resistance(const Vec3Array<Real>& v, Grabs<Real>& grabs) {
  for (Grab<Real>& grab : grabs.list) {
    if (grab.def.mode == GrabMode::live) grab.resisted = weighted_mean(grab, v) - grab.unresisted;
  }
}

template <class Real>
void add_sling_forces(const Grabs<Real>& grabs, Vec3Array<Real>& force) {
  for (const SlingImpulse<Real>& impulse : grabs.impulses)
    share_force(impulse.particles, impulse.weights, impulse.force, force);
}

template <class Real>
void begin_tick(Grabs<Real>& grabs) {
  for (Grab<Real>& grab : grabs.list) grab.given.setZero();
}

template <class Real>
void see_velocities(const Vec3Array<Real>& v, Grabs<Real>& grabs) {
  for (Grab<Real>& grab : grabs.list) {
    for (std::size_t n = 0; n < grab.particles.size(); ++n)
      grab.velocity[n] = v[static_cast<std::size_t>(grab.particles[n])];
  }
}

template <class Real>
double work_of_hands(const Vec3Array<Real>& v, Grabs<Real>& grabs) {
  double work = 0;
  for (Grab<Real>& grab : grabs.list) {
    assert(grab.velocity.size() == grab.particles.size());
    for (std::size_t n = 0; n < grab.particles.size(); ++n) {
      const Vec3<Real>& now = v[static_cast<std::size_t>(grab.particles[n])];
      const Vec3<Real> before = std::exchange(grab.velocity[n], now);
      work += static_cast<double>(grab.impulse[n].dot(before + now)) / 2;
    }
  }
  return work;
}

#define WEFT_INSTANTIATE(Real)                                                                    \
  template GrabId add_grab(const ClothModel<Real>&, const ClothState<Real>&, const GrabDef&,      \
                           Grabs<Real>&);                                                         \
  template void fit_hand(const ClothModel<Real>&, Grab<Real>&);                                   \
  template bool move_grab(GrabId, const Vec3d&, Grabs<Real>&);                                    \
  template bool remove_grab(GrabId, Grabs<Real>&);                                                \
  template std::optional<Vec3<Real>> fire_sling(GrabId, int, const ClothState<Real>&,             \
                                                Grabs<Real>&);                                    \
  template void lead_hands(double, const Vec3Array<Real>&, Grabs<Real>&);                         \
  template void finish_tick(double, Grabs<Real>&);                                                \
  template Vec3<Real> held_point(const Grab<Real>&, const Vec3Array<Real>&);                      \
  template void pull_by_hand(const HandStep<Real>&, Real, Real, ClothState<Real>&, Grabs<Real>&); \
  template void add_hand_forces(const HandStep<Real>&, Real, const Vec3<Real>&,                   \
                                const ClothState<Real>&, Grabs<Real>&, Vec3Array<Real>&);         \
  template void note_resistance(const Vec3Array<Real>&, Grabs<Real>&);                            \
  template void add_sling_forces(const Grabs<Real>&, Vec3Array<Real>&);                           \
  template void begin_tick(Grabs<Real>&);                                                         \
  template void see_velocities(const Vec3Array<Real>&, Grabs<Real>&);                             \
  template double work_of_hands(const Vec3Array<Real>&, Grabs<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
