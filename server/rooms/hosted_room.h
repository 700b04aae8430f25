#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/metrics.h"
#include "server/room/room.h"
#include "server/room/simulation_loop.h"
#include "server/rooms/mailbox.h"
#include "server/rooms/scene_builders.h"
#include "server/rooms/scheduler.h"
#include "server/work_limit.h"

namespace weft::server {

/// What every room of a server is given.
struct HostServices {
  Clock clock;
  Metrics& whole;
  Scheduler& scheduler;
  SceneBuilders& builders;
  LimitWatch& watch;
  Executor* executor = nullptr;
  double tick_limit = 0;             ///< of CPU [s]; 0: none
  std::size_t waiting_commands = 0;  ///< of one viewer
};

/// A room with its input, its limit and its output, as a scheduler gives it turns.
class HostedRoom : public Turns, public std::enable_shared_from_this<HostedRoom> {
 public:
  HostedRoom(std::string name, const HostServices& services);
  ~HostedRoom() override;

  /// Call once, before its first turn.
  /// @param scene  built; nothing: the first scene of the options, which is built now
  /// Throws DefinitionError if that cannot be built.
  void begin(RoomOptions options, const SceneSource& scenes, std::shared_ptr<RoomOutput> output,
             std::optional<BuiltScene> scene);

  const std::string& name() const { return name_; }
  /// Hands over what a viewer wants. False if it has too many commands waiting.
  bool put(Inbound item) { return mailbox_.put(std::move(item)); }
  RoomOutput& output() const { return *output_; }
  Metrics& metrics() { return metrics_; }
  const Metrics& metrics() const { return metrics_; }

  /// As it was at the end of its last turn. Callable from any thread, as are all below.
  proto::RoomInfo info() const;
  /// Of a tick of its present world. Before its first turn.
  TickCost cost() const { return room_->world().cost_in(room_->world().environment()); }
  /// Whether time passes as fast as it should, or stands.
  bool keeps_up() const { return keeps_up_.load(); }
  /// Since when it has been without viewers [s]; kNever: it has some.
  double empty_since() const { return empty_since_.load(); }
  bool closed() const { return closed_.load(); }
  /// No further turn of it begins, and its tick under way ends.
  void stop() { mailbox_.stop(); }
  /// Stops it for good, and closes the connections of its viewers.
  void close();
  /// Ends the building of a scene. Between turns.
  void cancel_build();

  Turn turn() override;
  void end() override { cancel_build(); }
  void note_cpu(double seconds) override { metrics_.count_cpu(seconds); }

 private:
  void give_way_at_stop_points();
  void post();

  const std::string name_;
  HostServices services_;
  Metrics metrics_;
  Mailbox mailbox_;
  WorkLimit limit_;
  std::shared_ptr<RoomOutput> output_;
  std::unique_ptr<Room> room_;
  std::optional<SimulationLoop<Room, Mailbox>> loop_;
  mutable std::mutex mutex_;  // of the next
  proto::RoomInfo info_;
  std::atomic<bool> keeps_up_ = true, closed_ = false;
  std::atomic<double> empty_since_;
};

}  // namespace weft::server
