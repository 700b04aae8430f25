#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "proto/messages/right.h"
#include "proto/types.h"
#include "server/clock.h"
#include "server/metrics.h"
#include "server/net/frame_packer.h"
#include "server/net/viewer_channel.h"

namespace weft::server {

/// Distributes a room's output to the channels of its viewers. Lives on the network thread; only
/// `wants_frames` and `wants_forces` may be called from other threads.
class Hub {
 public:
  Hub(Clock clock, double frame_rate, const ChannelLimits& limits, Metrics& metrics);

  /// Makes the channel of a viewer; the stream must outlive it (until `remove`).
  ViewerChannel& add(proto::ViewerId viewer, ViewerStream& stream);
  void remove(proto::ViewerId viewer);

  void send(proto::ViewerId viewer, Message message);
  void send(proto::ViewerId viewer, std::vector<Message> messages);
  /// To every welcomed viewer.
  void broadcast(const Message& message);
  void welcome_done(proto::ViewerId viewer);
  void offer_mesh(std::uint64_t hash, SharedBytes bytes, const PackedMesh& packed = {});
  void offer_frame(const Frame& frame);
  void set_frame_rate(double frame_rate);
  void set_most_frames(proto::ViewerId viewer, double hz);
  void want_forces(proto::ViewerId viewer, bool wanted);
  void set_role(proto::ViewerId viewer, proto::Role role);
  proto::Role role(proto::ViewerId viewer) const;
  /// Of what is told to all the viewer gets the state alone from now on, at most once a second.
  void set_glance(proto::ViewerId viewer);
  /// Packs the viewer's frames from now on, the first one as a key.
  /// @param usual  bound of their error [m]; 0: float32
  /// @param most   bound while the viewer does not keep up, at least as large [m]
  void want_packed(proto::ViewerId viewer, double usual, double most);

  /// Sends what has become due, tells viewers of dropped frames, counts. Call every 10 to 50 ms.
  void poll();

  /// Sends `last` to all viewers and closes their connections.
  void close_all(std::uint16_t code, const std::string& reason, const Message& last);

  /// Finds a mesh message by its hash: the present one or one of the last few.
  SharedBytes find_mesh(std::uint64_t hash) const;

  /// Whether any viewer takes frames; no frame needs to be encoded otherwise.
  bool wants_frames() const { return frame_takers_.load(std::memory_order_relaxed) > 0; }
  /// Whether any viewer takes contacts and reactions with its frames.
  bool wants_forces() const { return force_takers_.load(std::memory_order_relaxed) > 0; }
  std::size_t viewers() const { return viewers_.size(); }
  const FramePacker& packer() const { return packer_; }
  const Clock& clock() const { return clock_; }

 private:
  struct Viewer {
    std::unique_ptr<ViewerChannel> channel;
    bool welcomed = false;
    proto::Role role = proto::Role::viewer;
    double next_notice = 0;  ///< of dropped frames [s]
    bool glances = false;
    std::optional<Message> state;  ///< waits for a viewer that glances
    double next_state = 0;         ///< earliest time of it [s]
    std::uint64_t sent_counted = 0, dropped_counted = 0;
  };

  void count_takers();
  void count_frames(Viewer& viewer);
  void tell_state(Viewer& viewer);
  void tell_dropped(Viewer& viewer);
  void tell_quality(Viewer& viewer);

  Clock clock_;
  double frame_rate_;
  ChannelLimits limits_;
  Metrics& metrics_;
  FramePacker packer_;
  // Ordered, so that viewers are served in the same order in every run.
  std::map<proto::ViewerId, Viewer> viewers_;
  std::deque<std::pair<std::uint64_t, SharedBytes>> meshes_;
  std::atomic<int> frame_takers_{0}, force_takers_{0};
};

}  // namespace weft::server
