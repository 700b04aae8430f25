// Scheduled events of a scene: its own hands, winds and sudden disturbances.

#include <cassert>
#include <cmath>

#include "core/error.h"
#include "core/world/world.h"

namespace weft {
namespace {

/// The grab of a scene's hand: at a triangle with the held particle, all weight on that corner.
template <class Real>
GrabDef hold_of(const ClothModel<Real>& model, const HandDef& hand) {
  GrabDef def;
  PinDef place;
  place.place = MaterialPoint{hand.u, hand.v};
  place.cloth = hand.cloth;
  const Index particle = find_pinned(model, place).centre;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (model.triangles[t][k] != particle) continue;
      def.triangle = static_cast<Index>(t);
      def.barycentric = {0, 0, 0};
      def.barycentric[k] = 1;
    }
  }
  def.radius = hand.radius;
  def.stiffness = hand.stiffness;
  def.max_force = hand.max_force;
  return def;
}

}  // namespace

/// Puts all free particles into a ball around their middle.
template <class Real>
void World<Real>::gather(double radius, std::uint64_t seed) {
  assert(radius > 0);
  Vec3d middle = Vec3d::Zero();
  std::size_t count = 0;
  for (std::size_t i = 0; i < state_.x.size(); ++i) {
    if (pins_.pin_count[i] > 0) continue;
    middle += state_.x[i].template cast<double>();
    ++count;
  }
  if (count == 0) return;
  middle /= static_cast<double>(count);
  const double within = radius / std::sqrt(3.0);
  for (std::size_t i = 0; i < state_.x.size(); ++i) {
    if (pins_.pin_count[i] > 0) continue;
    for (int axis = 0; axis < 3; ++axis)
      state_.x[i][axis] = static_cast<Real>(
          middle[axis] + within * noise_at(seed, i, static_cast<std::uint64_t>(axis)));
  }
}

template <class Real>
void World<Real>::apply_disturbance(const DisturbanceDef& disturbance, std::uint64_t seed) {
  for (std::size_t i = 0; i < state_.x.size(); ++i) {
    if (pins_.pin_count[i] > 0) continue;
    for (int axis = 0; axis < 3; ++axis)
      state_.v[i][axis] += static_cast<Real>(disturbance.noise *
                                             noise_at(seed, i, static_cast<std::uint64_t>(axis)));
  }
  if (disturbance.gather > 0) gather(disturbance.gather, seed);
  if (disturbance.noise > 0 || disturbance.gather > 0) {
    const double before = report_.energies.total();
    accept_state();
    report_.brought += report_.energies.total() - before;
  }
  if (disturbance.pinned.isZero(0)) return;
  for (const Pin& pin : pins_.list) {
    PinMove move;
    move.target = pin.path ? pin.path->move.target
                           : state_.x[static_cast<std::size_t>(pin.centre)].template cast<double>();
    // Pins moved repeatedly stop at the limit of commanded targets.
    move.target = (move.target + disturbance.pinned)
                      .cwiseMax(-kFarthestPinTarget)
                      .cwiseMin(kFarthestPinTarget);
    move.speed = disturbance.pin_speed;
    move_pin(pin.id, move);
  }
}

template <class Real>
void World<Real>::run_script() {
  const auto tick_of = [this](double time) {
    return static_cast<std::uint64_t>(std::llround(time * def_.tick_rate));
  };
  for (std::size_t k = 0; k < def_.disturbances.size(); ++k) {
    if (tick_of(def_.disturbances[k].time) == tick_) apply_disturbance(def_.disturbances[k], k);
  }
  for (const WindKey& key : def_.winds) {
    if (tick_of(key.time) != tick_) continue;
    turn_wind(key.wind);
    wake_all();
  }
  assert(scene_hands_.size() == def_.hands.size());
  for (std::size_t k = 0; k < def_.hands.size(); ++k) {
    const HandDef& hand = def_.hands[k];
    assert(!hand.path.empty());
    SceneHand& held = scene_hands_[k];
    if (tick_of(hand.path.front().time) == tick_ && has_capacity(grabs_)) {
      GrabDef def = hold_of(model_, hand);
      for (std::size_t c = 0; c < 3; ++c) {
        const Index corner = model_.triangles[static_cast<std::size_t>(def.triangle)][c];
        def.target +=
            def.barycentric[c] * state_.x[static_cast<std::size_t>(corner)].template cast<double>();
      }
      held = {grab(def), def.target};
    }
    if (held.grab == 0) continue;
    if (tick_ > tick_of(hand.path.back().time)) {
      release(held.grab);
      held.grab = 0;
      continue;
    }
    move_grab(held.grab,
              held.start + offset_at(hand, static_cast<double>(tick_ + 1) / def_.tick_rate));
  }
}

template <class Real>
std::optional<std::size_t> World<Real>::scene_hand(GrabId id) const {
  for (std::size_t k = 0; k < scene_hands_.size(); ++k) {
    if (id != 0 && scene_hands_[k].grab == id) return k;
  }
  return std::nullopt;
}

#define WEFT_INSTANTIATE(Real)                                                        \
  template void World<Real>::gather(double, std::uint64_t);                           \
  template void World<Real>::apply_disturbance(const DisturbanceDef&, std::uint64_t); \
  template void World<Real>::run_script();                                            \
  template std::optional<std::size_t> World<Real>::scene_hand(GrabId) const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
