#pragma once

#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

namespace weft {

/// What a pin has left to go to a target, at most [m].
template <class Real>
double way_left(const Pin& pin, const ClothState<Real>& state, const Vec3d& target);

/// The least time in which a pin that stands, and that nothing holds back, gets over a way and is
/// fixed again [s].
/// @param way  [m], 0 and more
double least_seconds(double way, double tick_seconds);

/// The speed with which it does that within a time [m/s], within the range of speeds.
/// @param seconds  at least least_seconds
double speed_within(double way, double seconds, double tick_seconds);

/// Carries pins that are on their way, with bounded speed and force. Between kick and drift their
/// particles get the impulse that takes each to its place on the way at the end of the substep, but
/// together no more than the pin's force allows; contact then stops them as any others. A way that
/// they do not follow goes on from where they are. A pin that has arrived is fixed again.
template <class Real>
class PinDrive {
 public:
  /// Before a tick of `tick_seconds` [s]: tells each pin on its way how far to go in it.
  static void plan(double tick_seconds, const ClothState<Real>& state, Pins& pins);

  /// Each time that the tick is begun. Both must stay until its end.
  void begin_tick(double tick_seconds, const ClothModel<Real>& model, Pins& pins);

  /// Between the kick and the drift of `dt` [s].
  void before_drift(ClothState<Real>& state, Real dt);

  /// At the end of a tick, after the closing kick.
  void settle(ClothState<Real>& state, Real dt);

  /// Work of the pins on the cloth in this tick [J].
  double work() const { return work_; }

  /// After a tick that counts: fixes the pins that have arrived.
  /// @return whether masses changed
  static bool finish(double tick_seconds, ClothState<Real>& state, Pins& pins);

 private:
  void drive(ClothState<Real>& state, Real dt, double seconds);
  void drive(const Pin& pin, PinPath& path, ClothState<Real>& state, Real dt, double seconds);

  const ClothModel<Real>* model_ = nullptr;
  Pins* pins_ = nullptr;
  double tick_seconds_ = 0, elapsed_ = 0;  ///< of the tick [s]
  double work_ = 0;
};

extern template class PinDrive<float>;
extern template class PinDrive<double>;

}  // namespace weft
