#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/message.h"
#include "server/net/frame_packer.h"
#include "server/net/frame_window.h"
#include "server/net/viewer_quality.h"

namespace weft::server {

/// A viewer's connection as its channel sees it: the session over a socket, or a fake in a test.
class ViewerStream {
 public:
  virtual ~ViewerStream() = default;

  /// Starts a write; the stream calls `ViewerChannel::on_written` when it is done. The channel
  /// starts no second write before that.
  /// @param more  another one waits, so that both may go out together
  virtual void write(const Message& message, bool more) = 0;

  /// Starts to close; no write follows.
  virtual void close(std::uint16_t code, const std::string& reason) = 0;

  /// The viewer has been sent everything that precedes frames; its own messages may be read now.
  virtual void on_welcomed() {}
};

struct ChannelLimits {
  std::size_t queued_messages = 4096;  ///< more than its own commands can cause at once
  std::size_t queued_bytes = 8 << 20;  ///< without the largest, and without meshes and kept frames
};

/// The output queue of one viewer: a bounded queue of messages in order, and one slot for the
/// newest frame. A slow viewer gets fewer frames, never older ones, and delays no other viewer: a
/// newer frame takes the place of the one in the slot, and tells in its stead that the state was
/// replaced. A state message (`Topic`) waits at most once, so that only a viewer's own answers can
/// overflow its queue. Lives on the network thread.
class ViewerChannel {
 public:
  /// @param frame_rate  of the room [1/s]
  ViewerChannel(ViewerStream& stream, const Clock& clock, double frame_rate,
                const ChannelLimits& limits);

  /// Queues a message, in place of a waiting one of its topic. Closes with 4000 if the viewer does
  /// not read and the queue overflows.
  void send(Message message);
  /// The same for several, which go out together.
  void send(std::vector<Message> messages);

  /// The viewer was sent everything that precedes frames; until then `offer_frame` does nothing.
  void welcome_done();

  /// Replaces the waiting frame.
  void offer_frame(const Frame& frame);

  /// Drops the waiting frame: it belongs to an older mesh, or a newer one takes its place.
  void drop_frame() {
    owes_jump_ = owes_jump_ || (waiting_frame_ && waiting_frame_->jump);
    waiting_frame_.reset();
  }

  /// The viewer is not sent a frame that would tell it that the state was replaced; its next one
  /// does.
  void owe_jump() { owes_jump_ = true; }

  /// The viewer has decoded a frame.
  void on_acknowledged(std::uint32_t sequence);

  /// The pending write is done.
  void on_written();

  /// Sends what has become due and suits the quality to the viewer; call ten times a second or
  /// more.
  void poll();

  /// @param hz  most frames per second of real time, 0 to 240; 0: none
  void set_most_frames(double hz);
  /// The `hz` asked for [1/s]; the highest allowed, if none was.
  double most_frames() const { return most_frames_; }
  /// Whether its frames include contacts and reactions.
  void want_forces(bool wanted) { with_forces_ = wanted; }
  bool wants_forces() const { return with_forces_ && wants_frames(); }
  bool asked_forces() const { return with_forces_; }
  /// Frames are packed from now on when they are sent, the first one as a key.
  /// @param usual  bound of their error [m]; 0: they go as they are
  /// @param most   bound while the viewer does not keep up, at least as large [m]
  void pack_with(FramePacker& packer, double usual, double most);
  /// The usual bound [m]; 0: frames are not packed.
  double packed_error() const { return usual_error_; }
  bool wants_frames() const { return frames_allowed_ && !closing_ && most_frames_ > 0; }

  /// The room's frame rate has changed [1/s].
  void set_frame_rate(double frame_rate);

  /// Sends the queued messages and `last`, then closes. Frames are dropped; a viewer that does not
  /// read (4000, 4001) gets nothing more.
  void close(std::uint16_t code, const std::string& reason, std::optional<Message> last = {});

  bool closing() const { return closing_; }
  std::uint64_t frames_sent() const { return frames_sent_; }
  std::uint64_t frames_dropped() const { return frames_dropped_; }
  const FrameWindow& window() const { return window_; }

  /// Frames dropped since the last call, for a notice.
  std::uint64_t take_dropped();

  /// What the viewer is sent at most, for a notice.
  struct Sending {
    double hz = 0;     ///< frames a second
    double error = 0;  ///< bound [m]; 0: not packed
  };
  /// The same, if it changed since the last call because the viewer did not keep up, or does again.
  std::optional<Sending> take_change();

 private:
  void take(Message message);
  void enqueue(Message message);
  template <class Predicate>
  void drop_queued(Predicate&& is_old);
  bool overflows() const;
  void pump();
  bool frame_is_due(double now) const;
  double rate() const;
  double error() const;
  void apply_quality();
  void count_frame(const Frame& frame, double now);
  void start(Message message);

  ViewerStream& stream_;
  const Clock& clock_;
  ChannelLimits limits_;
  FrameWindow window_;
  double frame_rate_;
  double most_frames_;
  bool frames_allowed_ = false;
  bool with_forces_ = false;
  bool writing_ = false;
  bool closing_ = false, closed_ = false;
  std::uint16_t close_code_ = 0;
  std::string close_reason_;
  FramePacker* packer_ = nullptr;
  PackedStream packed_;
  double usual_error_ = 0, most_error_ = 0;  // [m]
  QualitySteps quality_;
  bool quality_changed_ = false;
  std::deque<Message> queue_;
  std::size_t queued_bytes_ = 0;  // of the messages that count
  std::optional<Frame> waiting_frame_;
  bool owes_jump_ = false;        // the next frame tells that the state was replaced
  double next_frame_time_ = 0;    // by `most_frames_`, at even spacing [s]
  double next_urgent_frame_ = 0;  // earliest that may precede it [s]
  std::uint64_t frames_sent_ = 0, frames_dropped_ = 0, dropped_told_ = 0;
};

}  // namespace weft::server
