#include <string>

#include "server/room.h"

// Ticks that a viewer requests, without a clock.

namespace weft::server {

void Room::advance_until(double deadline) {
  while (advance_ && advance_->left > 0 && !advance_->paused) {
    if (advance_waits()) {
      if (clock_() - advance_->taken < kStalled) break;
      viewers_.at(advance_->viewer).stalled = true;
      return finish_advance(stalled_error());
    }
    advance_->taken = clock_();
    const bool shown = shows_next_tick();
    if (!step_world()) return;  // announced, and the advance ended if nothing replaces it
    --advance_->left;
    if (!world_->report().rested) frames_.note_advance();
    if (shown) show_advanced();
    if (clock_() >= deadline) break;
  }
  if (!advance_) return;
  if (advance_->left == 0)
    finish_advance();
  else if (advance_->paused)
    end_paused_advance();
}

void Room::end_paused_advance() {
  end_advance(proto::ErrorCode::interrupted, "a viewer sent pause", "");
}

/// Whether the most frames of its own `advance` are in flight to a viewer.
bool Room::frames_wait(const Viewer& viewer) const {
  return viewer.ticket.use_count() > kMostFramesInFlight;
}

/// Whether the viewer of the advance asked for the frame of the coming tick.
bool Room::shows_next_tick() const {
  return advance_->frames == proto::AdvanceFrames::all ||
         (advance_->frames == proto::AdvanceFrames::last && advance_->left == 1);
}

bool Room::advance_waits() const {
  return advance_ && shows_next_tick() && frames_wait(viewers_.at(advance_->viewer));
}

void Room::show_advanced() {
  const Viewer& viewer = viewers_.at(advance_->viewer);
  const Frame frame = encode_frame();
  const bool full = viewer.wants_forces && frame.with_forces;
  output_.send(advance_->viewer,
               {full ? frame.with_forces : frame.bytes, true, Topic::frame, viewer.ticket});
}

/// Ends an `advance` whose viewer takes none of its frames, so that it does not hold up the room.
proto::Error Room::stalled_error() const {
  proto::Error error = proto::make_error(
      proto::ErrorCode::stalled,
      "the frames of this advance were not read for " + proto::number_text(kStalled) + " s",
      "it ended at tick " + std::to_string(world_->tick()) + "; read faster or ask for the last");
  error.command = "advance";
  if (advance_) error.id = advance_->id;
  return error;
}

void Room::finish_advance(const std::optional<proto::Error>& error) {
  const Advance done = *advance_;
  advance_.reset();
  log_.shorten_advance(done.left);
  if (error)
    output_.send(done.viewer, text_message(proto::encode_error(*error)));
  else
    answer(done.viewer, done.id, proto::AdvanceReply{world_->tick(), world_->hash()});
  news_.state = true;
}

}  // namespace weft::server
