#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "server/room/command_log.h"
#include "server/room/inbound.h"
#include "server/room/other_rooms.h"
#include "server/room/scene_build.h"

namespace weft::server {

/// An `advance` under way.
struct Advance {
  proto::ViewerId viewer = 0;
  std::optional<proto::Id> id;
  std::uint32_t left = 0;
  proto::Advance wanted;
  double taken = 0;     ///< when it was last free to continue [s]
  bool paused = false;  ///< by a viewer, within the tick that runs and ends it
};

/// A `load` or a `create_room` under way.
struct Building {
  proto::ViewerId viewer = 0;
  proto::Request request;
  std::shared_ptr<SceneBuild> build;
  std::shared_ptr<RoomName> name;  ///< of another room; null: it is for this one

  /// Whether the scene under way has no future.
  bool replaces() const { return !name && build->succeeded(); }
};

/// The one order of all viewers' commands: what was done, what is being done, and what waits, as it
/// arrived. Commands of one viewer never overtake each other: a pause behind others that wait for
/// their viewer's `advance` ends that at once, and is done after them.
struct Order {
  CommandLog log;
  std::optional<Advance> advance;
  std::optional<Building> building;
  std::deque<Inbound> waiting;
  /// Commands of viewers that may only look wait until then [s].
  double looks_from = 0;
};

template <class Command>
bool is(const Inbound& item) {
  const auto* request = std::get_if<proto::Request>(&item.what);
  return request && std::holds_alternative<Command>(request->command);
}

/// Whether it changes nothing of the cloth and needs no more of it than is known during a tick.
bool is_beside_the_cloth(const Inbound& item);
/// Whether it concerns the server's rooms and not this one's cloth, so that it is not logged.
bool is_about_rooms(const proto::Command& command);
/// Whether only its viewer would have any use of it, or it may have to wait for what outlasts its
/// viewer: a scene under construction.
bool is_for_its_viewer_alone(const Inbound& item);

/// Whether it is a pause by the viewer of the running `advance`, which does not wait for its end.
bool ends_its_advance(const Order& order, const Inbound& item);
/// Whether an `advance` or a `load` holds it up. These hold up only the later commands of their own
/// viewer, and a load other loads; all other commands run between the ticks of an `advance`.
bool is_held_up(const Order& order, const Inbound& item);
/// Puts an item behind what waits. Of a viewer's notes with no command between them one is kept,
/// with what all of them say: there may be any number of them, because no mailbox bounds them.
void add_waiting(Order& order, Inbound item);
/// Whether something of this viewer waits.
bool has_waiting(const Order& order, proto::ViewerId viewer);
/// Takes out what waits of this viewer.
std::vector<Inbound> take_waiting(Order& order, proto::ViewerId viewer);

}  // namespace weft::server
