#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "proto/messages/http.h"
#include "server/room/other_rooms.h"
#include "server/rooms/hosted_room.h"
#include "server/rooms/shared_pool.h"
#include "server/thread_pool.h"

namespace weft::server {

struct RoomsOptions {
  int threads = 1;                   ///< for the rooms
  std::size_t most = 64;             ///< rooms
  double idle_seconds = 0;           ///< an empty room closes after this; 0: never
  double tick_limit = 0;             ///< of CPU [s]; 0: none
  std::size_t waiting_commands = 0;  ///< of one viewer
  /// Called with the name of a room that closes, before another can take it; from any thread.
  std::function<void(const std::string&)> on_closed = [](const std::string&) {};
};

/// The rooms of a server: the default one, and those that viewers open. Callable from any thread.
class Rooms : public OtherRooms {
 public:
  /// Makes the output of a room.
  using OutputMaker = std::function<std::shared_ptr<RoomOutput>(Metrics&)>;

  /// @param usual    of the default room; the others have the same, but for name, scene and pause
  /// @param outputs  callable from any thread
  Rooms(const RoomsOptions& options, RoomOptions usual, SceneSource scenes, OutputMaker outputs,
        Clock clock, Metrics& whole);
  ~Rooms() override;

  /// Builds the default room, whose first turn `start` lets begin. Throws DefinitionError.
  void open_default();
  void start();

  /// Null if there is no such room.
  std::shared_ptr<HostedRoom> find(const std::string& name) const;
  /// All, by name.
  std::vector<std::shared_ptr<HostedRoom>> all() const;
  /// Of the room that is furthest from ready.
  proto::Readiness readiness() const;
  std::string metrics_text() const;
  /// Closes rooms that have been empty for too long. Call from time to time.
  void close_empty();

  /// Ends the turns under way; no other begins.
  void stop();
  bool stands() const { return scheduler_.running() == 0; }
  /// After that: cancels scenes that are being built.
  void cancel_builds();
  bool builds() const { return !builders_.idle(); }

  proto::ListRoomsReply list() const override;
  proto::Result<std::shared_ptr<RoomName>> reserve(const std::string& name,
                                                   const std::string& maker) override;
  proto::Result<proto::RoomInfo> open(const std::shared_ptr<RoomName>& name, BuiltScene&& scene,
                                      bool paused) override;
  std::optional<proto::Error> close(const std::string& name) override;
  bool others_have_viewers(const std::string& name) const override;
  std::optional<proto::Error> admit(const std::string& room, const TickCost& cost) override;

 private:
  class Reserved;

  HostServices services();
  bool shut(const std::string& name);
  std::optional<proto::Error> check_count(const std::string& maker) const;
  std::optional<proto::Error> check_sum(const std::string& room, const TickCost& cost,
                                        const std::function<bool(const std::string&)>& counts,
                                        const char* whose, double share) const;
  proto::Readiness readiness_of(const HostedRoom& room) const;

  RoomsOptions options_;
  RoomOptions usual_;
  SceneSource scenes_;
  OutputMaker outputs_;
  Clock clock_;
  Metrics& whole_;
  ThreadPool pool_;
  SharedPool shared_pool_;
  LimitWatch watch_;
  mutable std::mutex mutex_;  // of the next five
  std::map<std::string, std::shared_ptr<HostedRoom>> rooms_;
  std::set<std::string> reserved_;
  std::map<std::string, TickCost> costs_;      ///< of each room's world
  std::map<std::string, std::string> makers_;  ///< of the rooms, reserved or open, that have one
  bool stopped_ = false;
  // Their threads use what stands above.
  Scheduler scheduler_;
  SceneBuilders builders_;
};

}  // namespace weft::server
