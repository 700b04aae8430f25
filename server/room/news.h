#pragma once

#include <vector>

#include "server/message.h"
#include "server/translate/translate.h"

namespace weft::server {

/// What viewers have not been told yet. It is told together, at most once in a tick's time, so that
/// no viewer can flood the others by changing something.
struct News {
  bool state = false, roster = false, pins = false, grabs = false;  ///< they have changed
  bool ticks = false;  ///< an `advance` has changed the state, by ticks alone
  std::vector<proto::Notice> notices;
  bool presence = false;     ///< cursors, cameras and whom viewers follow; told by itself
  double next_presence = 0;  ///< earliest time to tell it [s]
  double next = 0;           ///< earliest time to tell it [s]
  double next_state = 0;     ///< the same for a state that only ticks have changed [s]

  bool any() const { return state || roster || pins || grabs || !notices.empty(); }
  /// Everything about the cloth has changed.
  void replace() { state = pins = grabs = true; }
  /// Keeps only the newest of equal notices that wait.
  void add(proto::Notice notice);
};

/// What viewers were told of the cloth last, between two ticks.
struct Told {
  Message state, pins, grabs;
  std::vector<char> asleep;  ///< of each cloth
  std::vector<PinId> moving_pins;
  std::vector<GrabId> scene_grabs;  ///< of the scene's own hands

  /// A scene at its start: no pin moves by itself, and none of its hands holds.
  void restart() {
    moving_pins.clear();
    scene_grabs.clear();
  }
};

// Whether something is to be told again, as it is in the world now; notes that it is.

/// Which cloths sleep.
bool note_sleep(const ServedWorld& world, Told& told);
/// The pins: one has set out, by the scene itself, or has arrived.
bool note_pins(const ServedWorld& world, Told& told);
/// The hands: one of the scene's own has taken hold or let go.
bool note_grabs(const ServedWorld& world, Told& told);

}  // namespace weft::server
