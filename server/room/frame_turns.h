#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "proto/types.h"

namespace weft::server {

/// Decides when a room sends a frame to all. Each tick of the clock makes one, whatever commands
/// come between ticks. Other changes make at most one in a tick's time, except the first after the
/// state was replaced. All times are in seconds of the room's clock.
class FrameTurns {
 public:
  // What has changed since the last frame to all.
  void note_command() { commanded_ = true; }
  void note_tick() { ticked_ = true; }
  void note_advance() { advanced_ = true; }
  /// The state was replaced.
  void note_jump() { commanded_ = jumped_ = advance_jumped_ = true; }
  /// What is seen makes a step that no motion explains.
  void note_break() { jumped_ = advance_jumped_ = true; }
  bool jumped() const { return jumped_; }
  /// The same for the viewer of the advance, which its own next frame shows.
  bool take_advance_jump() { return std::exchange(advance_jumped_, false); }

  /// Changes by earlier commands are shown together with those of the coming ticks.
  /// @param viewer  has the frames of these ticks already, or declined them; 0: none
  void begin_advance(proto::ViewerId viewer) {
    advanced_ = advanced_ || commanded_;
    commanded_ = false;
    advance_for_ = viewer;
    advance_jumped_ = jumped_;
  }

  /// When a frame to all is due; infinity if nothing visible has changed.
  /// @param stands  whether ticks make no frames now
  double next(bool stands) const {
    double next = std::numeric_limits<double>::infinity();
    if (ticked_) return -next;
    if (jumped_) next = next_jump_;
    if (advanced_ || jumped_ || (commanded_ && stands)) next = std::min(next, next_idle_);
    return next;
  }
  /// Earliest frame to one viewer that lacks the present one.
  double next_idle() const { return next_idle_; }

  /// The viewer that a frame to all need not go to; 0: none.
  proto::ViewerId excluded() const { return commanded_ || ticked_ ? 0 : advance_for_; }
  /// Whether that viewer has not been shown that the state was replaced, which such a frame tells.
  bool owes_jump() const { return advance_jumped_ && excluded() != 0; }
  /// Such a frame goes out now.
  /// @param pause  until the next one without a tick of the clock
  void sent(double now, double pause) {
    advance_for_ = excluded();
    if (jumped_) next_jump_ = now + pause;
    next_idle_ = now + pause;
    commanded_ = ticked_ = advanced_ = jumped_ = advance_jumped_ = false;
  }
  void sent_to_one(double now, double pause) { next_idle_ = now + pause; }

 private:
  bool commanded_ = false, ticked_ = false, advanced_ = false, jumped_ = false;
  bool advance_jumped_ = false;      ///< the same as jumped_, for the viewer of the advance
  double next_idle_ = 0;             ///< earliest one without a tick of the clock
  double next_jump_ = 0;             ///< earliest one that may precede those
  proto::ViewerId advance_for_ = 0;  ///< see begin_advance
};

}  // namespace weft::server
