#pragma once

#include <cstdint>
#include <deque>

namespace weft::server {

/// How many frames may be in flight to one viewer. An ack means decoded, so the window follows the
/// viewer and not the buffers between: W = clamp(ceil(least round trip * rate) + 1, 2, 12).
class FrameWindow {
 public:
  static constexpr int kLeast = 2;
  static constexpr int kMost = 12;

  /// @param frame_rate  most frames a second to this viewer
  explicit FrameWindow(double frame_rate) : frame_rate_(frame_rate) {}

  void set_frame_rate(double frame_rate) { frame_rate_ = frame_rate; }

  bool has_room() const { return static_cast<int>(unacknowledged_.size()) < size(); }
  int size() const;
  std::size_t in_flight() const { return unacknowledged_.size(); }

  /// A frame was sent. Sequences ascend.
  void sent(std::uint32_t sequence, double now);

  /// The viewer has decoded this frame and all before it. Unknown sequences change nothing.
  void acknowledge(std::uint32_t sequence, double now);

 private:
  struct Sent {
    std::uint32_t sequence;
    double time;
  };

  void note_round_trip(double seconds, double now);

  double frame_rate_;
  std::deque<Sent> unacknowledged_;
  // The least of the last 5 to 10 s, so that a route that became slower is noticed after a while.
  double least_now_ = -1, least_before_ = -1;  // [s]; negative: none yet
  double period_end_ = 0;
};

}  // namespace weft::server
