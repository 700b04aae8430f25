#include <string>
#include <utility>
#include <vector>

#include "server/room/room.h"
#include "server/translate/observation.h"

// Ticks that a viewer requests, without a clock.

namespace weft::server {

void Room::advance_until(double deadline) {
  while (order_.advance && order_.advance->left > 0 && !order_.advance->paused) {
    if (advance_waits()) {
      if (clock_() - order_.advance->taken < kStalled) break;
      viewers_.at(order_.advance->viewer).stalled = true;
      return finish_advance(stalled_error());
    }
    order_.advance->taken = clock_();
    const bool shown = shows_next_tick();
    if (!step_world()) return;  // announced, and the advance ended if nothing replaces it
    --order_.advance->left;
    if (!world_->report().rested) frames_.note_advance();
    if (shown) show_advanced();
    if (clock_() >= deadline) break;
  }
  if (!order_.advance) return;
  if (order_.advance->left == 0)
    finish_advance();
  else if (order_.advance->paused)
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
  const proto::Advance& wanted = order_.advance->wanted;
  const bool last = wanted.frames == proto::AdvanceFrames::last || wanted.observe;
  return wanted.frames == proto::AdvanceFrames::all || (last && order_.advance->left == 1);
}

bool Room::advance_waits() const {
  return order_.advance && shows_next_tick() && frames_wait(viewers_.at(order_.advance->viewer));
}

/// Whether its viewer gets contacts and reactions of the coming tick.
bool Room::advance_wants_forces() const {
  if (!order_.advance) return false;
  const proto::Advance& wanted = order_.advance->wanted;
  const bool last = order_.advance->left <= 1;
  if (last && wanted.observe && observes_forces(*wanted.observe)) return true;
  if (wanted.frames.value_or(proto::AdvanceFrames::none) == proto::AdvanceFrames::none)
    return false;
  const auto caller = viewers_.find(order_.advance->viewer);
  return caller != viewers_.end() && caller->second.wants_forces;
}

/// What the advance observes of its last tick is sent with its result, not here.
void Room::show_advanced() {
  if (order_.advance->wanted.observe && order_.advance->left == 0) return;
  const Viewer& viewer = viewers_.at(order_.advance->viewer);
  const Frame frame = encode_frame(frames_.take_advance_jump());
  const bool full = viewer.wants_forces && frame.with_forces;
  output_.send(order_.advance->viewer,
               {full ? frame.with_forces : frame.bytes, true, Topic::frame, viewer.ticket});
}

Message Room::observation() {
  FrameMaker::Facts facts = frame_facts(frames_.take_advance_jump());
  facts.forces = false;  // the observation has its own
  const Observation seen = observation_of(*world_, *order_.advance->wanted.observe);
  const SharedBytes frame = frame_maker_.make_for_one(
      *world_, holds_, facts, [&seen](proto::FrameView& view) { show(seen, view); });
  return {frame, true, Topic::frame, viewers_.at(order_.advance->viewer).ticket};
}

/// Ends an `advance` whose viewer takes none of its frames, so that it does not hold up the room.
proto::Error Room::stalled_error() const {
  proto::Error error = proto::make_error(
      proto::ErrorCode::stalled,
      "the frames of this advance were not read for " + proto::number_text(kStalled) + " s",
      "it ended at tick " + std::to_string(world_->tick()) + "; read faster or ask for the last");
  error.command = "advance";
  if (order_.advance) error.id = order_.advance->id;
  return error;
}

/// What was observed and the answer go out together, so that they wake the network thread and the
/// viewer once.
void Room::finish_advance(const std::optional<proto::Error>& error) {
  std::vector<Message> told;
  if (!error && order_.advance->wanted.observe) told.push_back(observation());
  const Advance done = *order_.advance;
  order_.advance.reset();
  if (error)
    told.push_back(text_message(proto::encode_error(*error)));
  else if (done.id)
    told.push_back(text_message(
        proto::encode_reply(*done.id, proto::AdvanceReply{world_->tick(), world_->hash()})));
  output_.send(done.viewer, std::move(told));
  order_.log.shorten_advance(done.left);
  frames_.note_advance();  // ticks of sleeping cloth make no frames, but viewers see where it ends
  news_.ticks = true;
  news_.state = news_.state || error;
}

}  // namespace weft::server
