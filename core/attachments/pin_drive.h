#pragma once

#include <vector>

#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

// Motion of pins with bounded speed and force.

namespace weft {

/// Remaining distance of a pin's middle particle to a target, or of its place if that is farther
/// [m].
template <class Real>
double remaining_distance(const Pin& pin, const ClothState<Real>& state, const Vec3d& target);

/// Least time in which a resting, unobstructed pin moves by a distance and is fixed again [s].
/// @param distance  [m], not negative
double least_seconds(double distance, double tick_seconds);

/// Speed that moves it by that distance within a time [m/s], clamped to the range of speeds.
/// @param seconds  at least least_seconds
double speed_within(double distance, double seconds, double tick_seconds);

/// Gives moving pins the velocities that their particles had before a tick that failed. A pin that
/// was sent in that tick had none.
/// @param before  at the start of the tick
void take_back_velocities(const Pins& before, Pins& pins);

/// Brings moving pins to rest where they are; from there they start anew.
void bring_to_rest(Pins& pins);

/// Moves pins with bounded speed and force. Between kick and drift their particles get the impulse
/// that brings each to its place at the end of the substep, but together no more than the pin's
/// force allows; contact with objects then stops them like any others, and what other cloth does to
/// them the pin bears as far as its force goes. If they do not follow, the pin continues from where
/// they are. A pin that has arrived is fixed again.
template <class Real>
class PinDrive {
 public:
  /// Call before a tick of `tick_seconds` [s]: plans the step of each moving pin.
  static void plan(double tick_seconds, const ClothState<Real>& state, Pins& pins);

  /// Call at each start of the tick. Both references must stay valid until its end.
  void begin_tick(double tick_seconds, const ClothModel<Real>& model, Pins& pins);

  /// Call between the kick and the drift of `dt` [s].
  /// @param force_ratio  see Collision::before_drift
  void before_drift(ClothState<Real>& state, Real dt, double force_ratio = 1);

  /// Call at the end of a tick, after the closing kick.
  void settle(ClothState<Real>& state, Real dt);

  /// Call after either, when contact of cloths has changed velocities: leads the particles on with
  /// what the pins' forces leave.
  /// @return the largest change of a velocity [m/s]
  Real lead_on(ClothState<Real>& state, Real dt);

  /// Whether it would: those of a pin that lags yield to what is in their way.
  bool leads() const;

  /// Work of the pins on the cloth in this tick [J].
  double work() const { return work_; }

  /// Call after a completed tick: fixes the pins that have arrived.
  /// @return whether masses changed
  static bool finish(double tick_seconds, ClothState<Real>& state, Pins& pins);

 private:
  /// What is left of a pin's impulses of a substep [N s].
  struct Left {
    double whole = 0;  ///< for its particles as a whole
    double apart = 0;  ///< to keep them in formation
  };

  void drive(ClothState<Real>& state, Real dt, double seconds);
  double drive(const Pin& pin, PinPath& path, ClothState<Real>& state, Real dt, Left& left);

  const ClothModel<Real>* model_ = nullptr;
  Pins* pins_ = nullptr;
  double tick_seconds_ = 0, elapsed_ = 0;  ///< of the tick [s]
  double force_ratio_ = 1;
  double work_ = 0;
  std::vector<Left> left_;  ///< of each pin
};

extern template class PinDrive<float>;
extern template class PinDrive<double>;

}  // namespace weft
