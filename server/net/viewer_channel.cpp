#include "server/net/viewer_channel.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

#include "proto/frames/frame.h"
#include "proto/limits.h"
#include "server/net/close_codes.h"

namespace weft::server {
namespace {

// Fractions of the frame interval: how early a frame may be sent, and how late one may come without
// delaying the next. Their sum is less than one, so that no second has more than `hz` + 1 frames,
// and ticks that come unevenly at that rate are all shown.
constexpr double kEarly = 0.25, kLate = 0.5;

/// Whether it counts towards the bound of bytes.
bool counts(const Message& message) {
  return message.topic != Topic::mesh_data && message.topic != Topic::frame;
}

std::span<const std::byte> bytes_of(const SharedBytes& frame) {
  return {static_cast<const std::byte*>(frame.data()), frame.size()};
}

bool tells_jump(const SharedBytes& frame) {
  return (proto::read_at<proto::BinaryHeader>(bytes_of(frame), 0).flags & proto::kFrameJump) != 0;
}

/// Whether an announced mesh makes it obsolete.
bool is_of_mesh(const Message& message) {
  return message.topic == Topic::mesh || message.topic == Topic::mesh_data ||
         message.topic == Topic::state || message.topic == Topic::pins ||
         message.topic == Topic::grabs;
}

}  // namespace

ViewerChannel::ViewerChannel(ViewerStream& stream, const Clock& clock, double frame_rate,
                             const ChannelLimits& limits)
    : stream_(stream), clock_(clock), limits_(limits), window_(frame_rate), frame_rate_(frame_rate),
      most_frames_(proto::kFrameRateRange.maximum) {}

void ViewerChannel::send(Message message) {
  take(std::move(message));
  pump();
}

void ViewerChannel::send(std::vector<Message> messages) {
  for (Message& message : messages) take(std::move(message));
  pump();
}

void ViewerChannel::take(Message message) {
  if (closing_ || closed_) return;
  if (message.topic == Topic::mesh) drop_queued(is_of_mesh);
  if (message.topic == Topic::frame) {
    drop_frame();  // it is older, and would follow
    message.jump = std::exchange(owes_jump_, false);
    ++frames_sent_;
  }
  enqueue(std::move(message));
  if (overflows()) close(kCloseViewerDoesNotRead, "the queue of messages overflowed");
}

/// In the place of the one that it replaces: frequent changes must not delay it.
void ViewerChannel::enqueue(Message message) {
  if (counts(message)) queued_bytes_ += message.bytes.size();
  const bool must_arrive = message.topic == Topic::none || message.topic == Topic::frame;
  const auto older = std::find_if(queue_.begin(), queue_.end(), [&](const Message& queued) {
    return !must_arrive && queued.topic == message.topic;
  });
  if (older == queue_.end()) {
    queue_.push_back(std::move(message));
    return;
  }
  if (counts(*older)) queued_bytes_ -= older->bytes.size();
  *older = std::move(message);
}

template <class Predicate>
void ViewerChannel::drop_queued(Predicate&& is_old) {
  for (const Message& message : queue_)
    if (is_old(message) && counts(message)) queued_bytes_ -= message.bytes.size();
  std::erase_if(queue_, is_old);
}

bool ViewerChannel::overflows() const {
  if (queue_.size() > limits_.queued_messages) return true;
  if (queued_bytes_ <= limits_.queued_bytes) return false;
  // One may be of any size, such as the positions of a large cloth as text.
  std::size_t largest = 0;
  for (const Message& message : queue_)
    if (counts(message)) largest = std::max(largest, message.bytes.size());
  return queued_bytes_ - largest > limits_.queued_bytes;
}

void ViewerChannel::welcome_done() {
  frames_allowed_ = true;
  stream_.on_welcomed();
}

void ViewerChannel::offer_frame(const Frame& frame) {
  if (!wants_frames()) {
    owes_jump_ = owes_jump_ || (frame.jump && frames_allowed_);
    return;
  }
  // A frame left out because of the viewer's rate does not count as dropped.
  const bool late =
      waiting_frame_ && (waiting_frame_->at_once || clock_() >= next_frame_time_ + kLate / rate());
  if (late && (writing_ || !window_.has_room())) ++frames_dropped_;
  const bool at_once = frame.at_once || (waiting_frame_ && waiting_frame_->at_once);
  drop_frame();
  waiting_frame_ = frame;
  waiting_frame_->at_once = at_once;
  waiting_frame_->jump = std::exchange(owes_jump_, false) || frame.jump;
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
  quality_.restart();
  apply_quality();
  if (hz == 0)
    drop_frame();
  else
    next_frame_time_ = std::min(next_frame_time_, clock_() + 1 / hz);
  pump();
}

void ViewerChannel::set_frame_rate(double frame_rate) {
  frame_rate_ = frame_rate;
  window_.set_frame_rate(std::min(frame_rate_, rate()));
}

void ViewerChannel::close(std::uint16_t code, const std::string& reason,
                          std::optional<Message> last) {
  if (closing_ || closed_) return;
  closing_ = true;
  close_code_ = code;
  close_reason_ = reason;
  waiting_frame_.reset();
  // A viewer that does not read would hold its queue and the pending write forever.
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
  if (!waiting_frame_ || !wants_frames() || !window_.has_room()) return false;
  return now >= next_frame_time_ - kEarly / rate() ||
         (waiting_frame_->at_once && now >= next_urgent_frame_);
}

void ViewerChannel::count_frame(const Frame& frame, double now) {
  window_.sent(frame.sequence, now);
  ++frames_sent_;
  const double interval = 1 / rate();
  next_frame_time_ = std::max(next_frame_time_, now - kLate * interval) + interval;
  if (frame.at_once) next_urgent_frame_ = now + interval;
}

void ViewerChannel::pump() {
  if (writing_ || closed_) return;
  if (!queue_.empty()) {
    Message message = std::move(queue_.front());
    queue_.pop_front();
    if (counts(message)) queued_bytes_ -= message.bytes.size();
    start(std::move(message));
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
  count_frame(frame, now);
  const bool full = with_forces_ && frame.with_forces;
  start({full ? frame.with_forces : frame.bytes, true, Topic::frame, {}, frame.jump});
}

void ViewerChannel::pack_with(FramePacker& packer, double usual, double most) {
  assert(usual >= 0 && most >= usual);
  packer_ = &packer;
  usual_error_ = usual;
  most_error_ = most;
  packed_ = {};
  packed_.error = error();
}

void ViewerChannel::poll() {
  const auto coarser =
      std::count_if(proto::kPackedErrors.begin(), proto::kPackedErrors.end(), [this](double bound) {
        return usual_error_ > 0 && bound > usual_error_ && bound <= most_error_;
      });
  if (quality_.update(clock_(), frames_sent_, frames_dropped_, static_cast<int>(coarser))) {
    apply_quality();
    quality_changed_ = true;
  }
  pump();
}

/// Most frames a second that the viewer takes, at even spacing.
double ViewerChannel::rate() const {
  const int pace = quality_.quality().pace;
  return pace == 1 ? most_frames_ : std::min(most_frames_, frame_rate_ / pace);
}

/// Bound of the error of packed frames [m].
double ViewerChannel::error() const {
  double bound = usual_error_;
  int steps = quality_.quality().coarser;
  for (const double coarser : proto::kPackedErrors)
    if (steps > 0 && coarser > bound && coarser <= most_error_) bound = coarser, --steps;
  return bound;
}

void ViewerChannel::apply_quality() {
  window_.set_frame_rate(std::min(frame_rate_, rate()));
  if (packed_.error == error()) return;
  packed_ = {};  // another lattice: the next frame is a key
  packed_.error = error();
}

std::optional<ViewerChannel::Sending> ViewerChannel::take_change() {
  if (!std::exchange(quality_changed_, false)) return std::nullopt;
  return Sending{std::min(frame_rate_, rate()), packed_.error};
}

void ViewerChannel::start(Message message) {
  writing_ = true;
  if (message.jump) packed_.held = 0;  // so that it is a key
  if (message.topic == Topic::frame && packer_)
    message.bytes = packer_->pack(message.bytes, packed_);
  if (message.jump && !tells_jump(message.bytes))
    message.bytes = SharedBytes(proto::with_jump(bytes_of(message.bytes)));
  stream_.write(message, !queue_.empty());
}

}  // namespace weft::server
