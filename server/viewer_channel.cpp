#include "server/viewer_channel.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "server/close_codes.h"

namespace weft::server {

ViewerChannel::ViewerChannel(ViewerStream& stream, const Clock& clock, double frame_rate,
                             const ChannelLimits& limits)
    : stream_(stream), clock_(clock), limits_(limits), window_(frame_rate), frame_rate_(frame_rate),
      most_frames_(std::numeric_limits<double>::infinity()) {}

void ViewerChannel::send(Message message) {
  if (closing_ || closed_) return;
  const std::size_t size = message.bytes.size();
  // One message larger than the bound is let through alone; a big cloth's mesh may be one.
  if (queue_.size() >= limits_.queued_messages ||
      (!queue_.empty() && queued_bytes_ + size > limits_.queued_bytes)) {
    close(kCloseViewerDoesNotRead, "the queue of messages overflowed");
    return;
  }
  queued_bytes_ += size;
  queue_.push_back(std::move(message));
  pump();
}

void ViewerChannel::welcome_done() {
  frames_allowed_ = true;
  stream_.on_welcomed();
}

void ViewerChannel::offer_frame(const Frame& frame) {
  if (!wants_frames()) return;
  // A frame left out because the viewer asked for fewer is not a dropped one.
  if (waiting_frame_ && (writing_ || !window_.has_room())) ++frames_dropped_;
  waiting_frame_ = frame;
  pump();
}

void ViewerChannel::on_acknowledged(std::uint32_t sequence) {
  window_.acknowledge(sequence, clock_());
  pump();
}

void ViewerChannel::on_written() {
  writing_ = false;
  pump();
}

void ViewerChannel::set_most_frames(double hz) {
  most_frames_ = hz;
  window_.set_frame_rate(std::min(frame_rate_, most_frames_));
  if (hz == 0) waiting_frame_.reset();
  next_frame_time_ = 0;
  pump();
}

void ViewerChannel::set_frame_rate(double frame_rate) {
  frame_rate_ = frame_rate;
  window_.set_frame_rate(std::min(frame_rate_, most_frames_));
}

double ViewerChannel::frame_interval() const {
  return most_frames_ >= frame_rate_ ? 0 : 1 / most_frames_;
}

void ViewerChannel::close(std::uint16_t code, const std::string& reason,
                          std::optional<Message> last) {
  if (closing_ || closed_) return;
  closing_ = true;
  close_code_ = code;
  close_reason_ = reason;
  waiting_frame_.reset();
  // A viewer that does not read would keep its queue and the write in flight for ever.
  if (code == kCloseViewerDoesNotRead || code == kCloseNoPong) {
    queue_.clear();
    closed_ = true;
    stream_.close(code, reason);
    return;
  }
  if (last) queue_.push_back(std::move(*last));
  pump();
}

std::uint64_t ViewerChannel::take_dropped() {
  return frames_dropped_ - std::exchange(dropped_told_, frames_dropped_);
}

bool ViewerChannel::frame_is_due(double now) const {
  return waiting_frame_ && wants_frames() && window_.has_room() && now >= next_frame_time_;
}

void ViewerChannel::pump() {
  if (writing_ || closed_) return;
  if (!queue_.empty()) {
    const Message message = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= std::min(queued_bytes_, message.bytes.size());
    start(message);
    return;
  }
  if (closing_) {
    closed_ = true;
    stream_.close(close_code_, close_reason_);
    return;
  }
  const double now = clock_();
  if (!frame_is_due(now)) return;
  const Frame frame = *std::exchange(waiting_frame_, std::nullopt);
  window_.sent(frame.sequence, now);
  ++frames_sent_;
  // Due times follow one another without drift, but do not pile up behind a pause.
  const double interval = frame_interval();
  next_frame_time_ = (now - next_frame_time_ < interval ? next_frame_time_ : now) + interval;
  start({with_forces_ && frame.with_forces ? frame.with_forces : frame.bytes, true});
}

void ViewerChannel::start(const Message& message) {
  writing_ = true;
  stream_.write(message);
}

}  // namespace weft::server
