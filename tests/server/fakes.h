#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "proto/messages/commands.h"
#include "server/net/viewer_channel.h"
#include "server/room/other_rooms.h"
#include "server/room/room.h"
#include "server/room/room_output.h"

// A clock that is set by hand, a stream that writes when it is told to, and an output that
// remembers.

namespace weft::server {

struct FakeClock {
  double now = 100;
  std::function<double()> between_reads;  ///< what passes from one look to the next [s]; null: none
  Clock clock() {
    return [this] { return between_reads ? now += between_reads() : now; };
  }
};

inline std::string text_of(const Message& message) {
  return {static_cast<const char*>(message.bytes.data()), message.bytes.size()};
}

/// A viewer's connection that never writes by itself.
struct FakeStream : ViewerStream {
  std::vector<std::string> written;  ///< messages whose write was started
  int in_flight = 0, most_in_flight = 0;
  bool more_follows = false;  ///< than the last one
  std::optional<std::uint16_t> closed;
  ViewerChannel* channel = nullptr;

  void write(const Message& message, bool more) override {
    more_follows = more;
    written.push_back(text_of(message));
    most_in_flight = std::max(most_in_flight, ++in_flight);
  }
  void close(std::uint16_t code, const std::string&) override { closed = code; }

  /// The write in flight is done.
  void finish_write() {
    --in_flight;
    channel->on_written();
  }
  /// All that can be written without further acks.
  void drain() {
    while (in_flight > 0) finish_write();
  }
};

/// A channel with its clock and its stream, past its welcome.
struct OneViewer {
  explicit OneViewer(ChannelLimits limits = {}) : channel(stream, time, 60, limits) {
    stream.channel = &channel;
    channel.welcome_done();
  }

  FakeClock fake;
  Clock time = fake.clock();
  FakeStream stream;
  ViewerChannel channel;
};

inline Frame fake_frame(std::uint32_t sequence) {
  return {SharedBytes("frame " + std::to_string(sequence)), sequence};
}

/// What a room has said.
struct RecordingOutput : RoomOutput {
  std::vector<std::pair<proto::ViewerId, std::string>> sent;  ///< text; viewer 0: to all
  std::vector<std::string> binary;
  std::vector<std::string> frames;  ///< that were offered, to all or to one
  std::vector<Frame> offered;       ///< the same
  std::vector<std::pair<proto::ViewerId, std::string>> kept_frames;  ///< sent to one for sure
  bool takes_kept_frames = true;                                     ///< else they wait
  std::vector<std::shared_ptr<const void>> waiting;
  bool viewers_want_frames = true, viewers_want_forces = false;
  std::vector<std::string> frames_with_forces;

  using RoomOutput::send;
  void send(proto::ViewerId viewer, Message message) override {
    if (message.topic == Topic::frame) {
      kept_frames.emplace_back(viewer, text_of(message));
      if (!takes_kept_frames) waiting.push_back(message.ticket);
    } else if (message.binary)
      binary.push_back(text_of(message));
    else
      sent.emplace_back(viewer, text_of(message));
  }
  void broadcast(Message message) override { sent.emplace_back(0, text_of(message)); }
  void set_frame_rate(double) override {}
  void offer_mesh(std::uint64_t, SharedBytes, PackedMesh) override {}
  void welcome_done(proto::ViewerId) override {}
  bool wants_frames() const override { return viewers_want_frames; }
  bool wants_forces() const override { return viewers_want_forces; }
  void offer_frame(Frame frame) override {
    if (frame.with_forces) frames_with_forces.push_back(text_of({frame.with_forces, true}));
    frames.push_back(text_of({frame.bytes, true}));
    offered.push_back(std::move(frame));
  }
  void close() override {}
  /// How many frames this viewer was offered.
  long frames_for(proto::ViewerId viewer) const {
    return std::count_if(offered.begin(), offered.end(), [viewer](const Frame& frame) {
      return frame.not_to != viewer && (frame.only_to == 0 || frame.only_to == viewer);
    });
  }

  /// The last message with this `op` (and, for results and errors, this id).
  nlohmann::json last(const std::string& op, const nlohmann::json& id = nullptr) const {
    for (auto it = sent.rbegin(); it != sent.rend(); ++it) {
      auto message = nlohmann::json::parse(it->second);
      if (message["op"] == op && (id.is_null() || message.value("id", nlohmann::json()) == id))
        return message;
    }
    return nullptr;
  }
  std::size_t count(const std::string& op) const {
    std::size_t found = 0;
    for (const auto& [viewer, text] : sent)
      if (nlohmann::json::parse(text)["op"] == op) ++found;
    return found;
  }
};

/// Rooms of which another one may have viewers, and that together may cost so much.
struct OneOtherRoom : OtherRooms {
  bool has_viewers = false;
  int reserved = 0;
  double most_updates = 1e18;  ///< that a room may cost in a tick

  proto::ListRoomsReply list() const override { return {}; }
  proto::Result<std::shared_ptr<RoomName>> reserve(const std::string&,
                                                   const std::string&) override {
    ++reserved;
    return std::shared_ptr<RoomName>();
  }
  proto::Result<proto::RoomInfo> open(const std::shared_ptr<RoomName>&, BuiltScene&&,
                                      bool) override {
    return proto::RoomInfo{};
  }
  std::optional<proto::Error> close(const std::string&) override { return std::nullopt; }
  bool others_have_viewers(const std::string&) const override { return has_viewers; }
  std::optional<proto::Error> admit(const std::string&, const TickCost& cost) override {
    if (cost.updates() <= most_updates) return std::nullopt;
    return proto::make_error(proto::ErrorCode::too_costly, "too much");
  }
};

/// A small cloth hung by its upper corners.
inline WorldDef small_scene(const std::string& name) {
  if (name != "small" && name != "other") throw DefinitionError("scene", name, "small or other");
  WorldDef def;
  def.cloths[0].rows = name == "small" ? 6 : 5;
  def.cloths[0].columns = 7;
  def.cloths[0].width = def.cloths[0].height = 0.5;
  def.cloths[0].origin = Vec3d(-0.25, 1, 0);
  def.pins = {{0, 0}, {6, 0}};
  def.colliders = {{"floor", PlaneDef{Vec3d(0, -2, 0), Vec3d::UnitY()}},
                   {"ball", SphereDef{Vec3d(0, -1, 0), 0.1}}};
  return def;
}

/// A room with a fake clock and an output that remembers.
struct TestRoom {
  explicit TestRoom(bool paused = true,
                    std::vector<std::pair<std::string, std::string>> settings = {},
                    RoomOptions options = {}) {
    options.settings = std::move(settings);
    options.scene = "small";
    options.scene_names = {"small", "other"};
    options.paused = paused;
    room = std::make_unique<Room>(options, small_scene, output, clock.clock(), metrics);
  }

  void join(proto::ViewerId viewer) { room->take({viewer, 0, Join{}}); }
  void leave(proto::ViewerId viewer) {
    if (!room->ticking()) clock.now += room->world().tick_seconds();
    room->take({viewer, 0, Leave{}});
  }

  /// Hands a command over as its JSON text would arrive.
  void tell(proto::ViewerId viewer, const std::string& text) {
    auto request = proto::parse_request(text);
    if (!request) throw std::runtime_error("the test's own command is wrong: " + text);
    room->take({viewer, ++number, *request});
  }

  /// Hands a command over, lets the room finish its turn and returns the answer (null without id).
  /// While no ticks pass, a tick's time does before, so that changes are told at once.
  nlohmann::json say(proto::ViewerId viewer, const std::string& text) {
    auto request = proto::parse_request(text);
    if (!request) throw std::runtime_error("the test's own command is wrong: " + text);
    if (!room->ticking()) clock.now += room->world().tick_seconds();
    room->take({viewer, ++number, *request});
    while (room->advancing()) room->advance_until(clock.now + 1);
    room->finish_turn();
    if (!request->id) return nullptr;
    const auto id = std::get<std::int64_t>(*request->id);
    const auto result = output.last("result", id);
    return result.is_null() ? output.last("error", id) : result;
  }

  void tick(int count) {
    for (int i = 0; i < count; ++i) {
      clock.now += room->tick_interval();
      room->tick();
      room->finish_turn();
    }
  }

  FakeClock clock;
  RecordingOutput output;
  Metrics metrics;
  std::unique_ptr<Room> room;
  std::uint32_t number = 0;
};

}  // namespace weft::server
