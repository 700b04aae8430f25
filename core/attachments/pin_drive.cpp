// Drives the particles of moving pins with bounded impulses.

#include "core/attachments/pin_drive.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/attachments/constants.h"

namespace weft {
namespace {

/// Largest distance of a particle from its place.
template <class Real>
double farthest(const Pin& pin, const ClothState<Real>& state) {
  assert(pin.path && pin.path->start.size() == pin.particles.size());
  double most2 = 0;
  for (std::size_t n = 0; n < pin.particles.size(); ++n) {
    const auto& x = state.x[static_cast<std::size_t>(pin.particles[n])];
    const Vec3d off = pin.path->start[n] + pin.path->offset - x.template cast<double>();
    most2 = std::max(most2, off.squaredNorm());
  }
  return std::sqrt(most2);
}

/// Remaining displacement [m].
Vec3d rest_of(const Pin& pin) {
  assert(pin.path);
  const auto centre = static_cast<std::size_t>(
      std::lower_bound(pin.particles.begin(), pin.particles.end(), pin.centre) -
      pin.particles.begin());
  assert(centre < pin.particles.size() && pin.particles[centre] == pin.centre);
  return pin.path->move.target - (pin.path->start[centre] + pin.path->offset);
}

/// Whether a pin moves, and its particles follow.
bool is_led(const Pin& pin) {
  return pin.path && !pin.path->behind;
}

/// The largest pace from which a pin can stop after a distance [m/s], if each tick, and the end of
/// the last one, may take kPinAcceleration times a tick of it. In units of that, n such ticks cover
/// n u - n (n - 1)/2; the fewest that may do have a last pace of at most 1.
double pace_before_stop(double distance, double tick_seconds) {
  assert(distance > 0 && tick_seconds > 0);
  const double change = kPinAcceleration * tick_seconds,
               covered = distance / (change * tick_seconds),
               ticks = std::max(1.0, std::ceil((std::sqrt(1 + 8 * covered) - 1) / 2));
  return change * (covered / ticks + (ticks - 1) / 2);
}

/// Resets the places of a pin's particles to slightly ahead of these, towards the target: it leads
/// lagging particles, around obstacles if friction permits.
template <class Real>
void lead_from_here(const Pin& pin, const ClothState<Real>& state, PinPath& path) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t n = 0; n < pin.particles.size(); ++n)
    sum +=
        state.x[static_cast<std::size_t>(pin.particles[n])].template cast<double>() - path.start[n];
  path.offset = sum / static_cast<double>(pin.particles.size());
  const Vec3d rest = rest_of(pin);
  const double distance = rest.norm();
  path.offset += distance > kPinSlack ? (rest * (kPinSlack / distance)).eval() : rest;
  path.pace = 0;
}

}  // namespace

double least_seconds(double distance, double tick_seconds) {
  assert(distance >= 0 && tick_seconds > 0);
  const double pace = std::min(kMostPinSpeed, std::sqrt(kPinAcceleration * distance));
  const double moving = pace > 0 ? distance / pace + pace / kPinAcceleration : 0;
  return moving + kPinTicksAtTarget * tick_seconds;
}

double speed_within(double distance, double seconds, double tick_seconds) {
  assert(distance >= 0 && tick_seconds > 0);
  if (distance == 0) return kLeastPinSpeed;
  const double moving = seconds - kPinTicksAtTarget * tick_seconds;
  // distance / v + v / a = moving; the slower of the two solutions.
  const double root = std::sqrt(std::max(0.0, moving * moving - 4 * distance / kPinAcceleration));
  return std::clamp(2 * distance / (moving + root), kLeastPinSpeed, kMostPinSpeed);
}

void take_back_velocities(const Pins& before, Pins& pins) {
  for (Pin& pin : pins.list) {
    if (!pin.path) continue;
    const auto known = std::find_if(before.list.begin(), before.list.end(),
                                    [&pin](const Pin& other) { return other.id == pin.id; });
    if (known != before.list.end() && known->path)
      pin.path->velocity = known->path->velocity;
    else
      std::fill(pin.path->velocity.begin(), pin.path->velocity.end(), Vec3d::Zero());
  }
}

void bring_to_rest(Pins& pins) {
  for (Pin& pin : pins.list) {
    if (!pin.path) continue;
    std::fill(pin.path->velocity.begin(), pin.path->velocity.end(), Vec3d::Zero());
    pin.path->impulse.setZero();
    pin.path->pace = 0;
  }
}

template <class Real>
double remaining_distance(const Pin& pin, const ClothState<Real>& state, const Vec3d& target) {
  const Vec3d here = state.x[static_cast<std::size_t>(pin.centre)].template cast<double>();
  const double distance = (target - here).norm();
  if (!pin.path) return distance;
  return std::max(distance, (rest_of(pin) + target - pin.path->move.target).norm());
}

template <class Real>
void PinDrive<Real>::plan(double tick_seconds, const ClothState<Real>& state, Pins& pins) {
  assert(tick_seconds > 0);
  for (Pin& pin : pins.list) {
    if (!pin.path) continue;
    PinPath& path = *pin.path;
    path.step.setZero();
    const bool behind = farthest(pin, state) > kPinSlack;
    path.behind = behind;
    if (behind) lead_from_here(pin, state, path);
    const Vec3d rest = rest_of(pin);
    const double distance = rest.norm();
    if (behind) continue;
    if (distance < kArrivalDistance) {
      path.pace = 0;
      continue;
    }
    path.pace = std::min({path.move.speed, path.pace + kPinAcceleration * tick_seconds,
                          pace_before_stop(distance, tick_seconds)});
    path.step = path.pace * tick_seconds < distance
                    ? (rest * (path.pace * tick_seconds / distance)).eval()
                    : rest;
  }
}

template <class Real>
void PinDrive<Real>::begin_tick(double tick_seconds, const ClothModel<Real>& model, Pins& pins) {
  assert(tick_seconds > 0);
  assert(pins.pin_count.size() == model.mass.size());
  model_ = &model;
  pins_ = &pins;
  tick_seconds_ = tick_seconds;
  elapsed_ = work_ = 0;
  left_.assign(pins.list.size(), {});
  for (Pin& pin : pins.list) {
    if (pin.path) pin.path->impulse.setZero();
  }
}

template <class Real>
void PinDrive<Real>::before_drift(ClothState<Real>& state, Real dt, double force_ratio) {
  assert(dt > 0);
  force_ratio_ = force_ratio;
  // The first kick of a tick is half a kick, and limits the pins' impulse likewise.
  const bool first = elapsed_ == 0;
  elapsed_ += static_cast<double>(dt);
  drive(state, dt, static_cast<double>(dt) * (first ? 0.5 : 1));
}

template <class Real>
void PinDrive<Real>::settle(ClothState<Real>& state, Real dt) {
  assert(dt > 0);
  force_ratio_ = 1;
  elapsed_ += static_cast<double>(dt);
  drive(state, dt, static_cast<double>(dt) / 2);
}

template <class Real>
void PinDrive<Real>::drive(ClothState<Real>& state, Real dt, double seconds) {
  assert(pins_ && model_ && "begin_tick comes first");
  assert(state.x.size() == model_->mass.size());
  for (std::size_t k = 0; k < left_.size(); ++k) {
    Pin& pin = pins_->list[k];
    if (!pin.path) continue;
    const double most = pin.path->move.max_force * seconds;
    left_[k] = {most, most};
    drive(pin, *pin.path, state, dt, left_[k]);
  }
}

template <class Real>
Real PinDrive<Real>::lead_on(ClothState<Real>& state, Real dt) {
  assert(left_.size() == pins_->list.size());
  double most = 0;
  for (std::size_t k = 0; k < left_.size(); ++k) {
    Pin& pin = pins_->list[k];
    if (is_led(pin)) most = std::max(most, drive(pin, *pin.path, state, dt, left_[k]));
  }
  return static_cast<Real>(most);
}

template <class Real>
bool PinDrive<Real>::leads() const {
  return std::any_of(pins_->list.begin(), pins_->list.end(), is_led);
}

/// Bounds two impulses separately: that of the particles as a whole, and the one that keeps them in
/// formation.
/// @return the largest change of a velocity [m/s]
template <class Real>
double PinDrive<Real>::drive(const Pin& pin, PinPath& path, ClothState<Real>& state, Real dt,
                             Left& left) {
  const Vec3d offset = path.offset + path.step * (elapsed_ / tick_seconds_);
  const double fastest = path.move.speed * kPinCatchUp;
  const auto is_free = [&](std::size_t i) { return state.inverse_mass[i] > 0; };
  const auto change = [&](std::size_t n, std::size_t i) -> Vec3d {
    Vec3d wanted =
        (path.start[n] + offset - state.x[i].template cast<double>()) / static_cast<double>(dt);
    const double speed = wanted.norm();
    if (speed > fastest) wanted *= fastest / speed;
    return wanted - state.v[i].template cast<double>();
  };
  double mass = 0;
  Vec3d sum = Vec3d::Zero();
  for (std::size_t n = 0; n < pin.particles.size(); ++n) {
    const auto i = static_cast<std::size_t>(pin.particles[n]);
    if (!is_free(i)) continue;
    const auto m = static_cast<double>(model_->mass[i]);
    mass += m;
    sum += change(n, i) * m;
  }
  if (mass == 0) return 0;
  const Vec3d mean = sum / mass;
  double apart = 0;
  for (std::size_t n = 0; n < pin.particles.size(); ++n) {
    const auto i = static_cast<std::size_t>(pin.particles[n]);
    if (is_free(i)) apart += (change(n, i) - mean).norm() * static_cast<double>(model_->mass[i]);
  }
  const double whole = sum.norm() > left.whole ? left.whole / sum.norm() : 1;
  const double own = apart > left.apart ? left.apart / apart : 1;
  left.whole = std::max(0.0, left.whole - sum.norm());
  left.apart = std::max(0.0, left.apart - apart);
  double largest = 0;
  for (std::size_t n = 0; n < pin.particles.size(); ++n) {
    const auto i = static_cast<std::size_t>(pin.particles[n]);
    if (!is_free(i)) continue;
    const Vec3d before = state.v[i].template cast<double>();
    const Vec3d given = mean * whole + (change(n, i) - mean) * own;
    const Vec3d after = before + given;
    state.v[i] = after.template cast<Real>();
    // Forces that the pin merely cancels do no work: only the drift before and after counts, not
    // the kick in between.
    work_ += static_cast<double>(model_->mass[i]) * force_ratio_ *
             given.dot(path.velocity[n] + after) / 2;
    path.velocity[n] = after;
    largest = std::max(largest, given.norm());
  }
  path.impulse += sum * (whole * force_ratio_);
  return largest;
}

template <class Real>
bool PinDrive<Real>::finish(double tick_seconds, ClothState<Real>& state, Pins& pins) {
  assert(tick_seconds > 0);
  bool changed = false;
  for (Pin& pin : pins.list) {
    if (!pin.path) continue;
    PinPath& path = *pin.path;
    pin.drive = path.impulse / tick_seconds;
    const bool stood = path.step.isZero(0);
    path.offset += path.step;
    if (!stood || !(rest_of(pin).norm() < kArrivalDistance)) continue;
    const double rounding = state.x[static_cast<std::size_t>(pin.centre)].norm() * kPinRoundings *
                            static_cast<double>(std::numeric_limits<Real>::epsilon());
    if (farthest(pin, state) > std::max(kPinArrived, rounding)) continue;
    stop_pin(pin.id, pins, state);
    changed = true;
  }
  return changed;
}

template class PinDrive<float>;
template class PinDrive<double>;
template double remaining_distance(const Pin&, const ClothState<float>&, const Vec3d&);
template double remaining_distance(const Pin&, const ClothState<double>&, const Vec3d&);

}  // namespace weft
