#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "server/room.h"
#include "server/translate_forces.h"
#include "server/translate_holds.h"

// When a room sends frames and announces changes, and what they contain.

namespace weft::server {

/// Measures contacts and reactions as long as a viewer wants them.
void Room::measure_forces() {
  bool wanted = output_.wants_forces();
  if (advance_ &&
      advance_->frames.value_or(proto::AdvanceFrames::none) != proto::AdvanceFrames::none) {
    const auto caller = viewers_.find(advance_->viewer);
    wanted = wanted || (caller != viewers_.end() && caller->second.wants_forces);
  }
  if (wanted == measures_forces_) return;
  measures_forces_ = wanted;
  within_limit([this] { world_->measure_forces(measures_forces_); });
}

void Room::show_to_those_who_lack(double now) {
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.wants_frame) continue;
    show_to(id);
    next_idle_frame_ = now + world_->tick_seconds();
  }
}

/// Whether ticks make no frames now: the clock makes no ticks, or all cloth sleeps.
bool Room::frames_stand() const {
  return !ticking() || world_->report().rested;
}

/// When a frame to all is due [s]; infinity if nothing visible has changed. Each tick of the clock
/// makes one, whatever commands come between ticks. Other changes make at most one per tick's time,
/// except the first after the state was replaced.
double Room::next_frame() const {
  double next = std::numeric_limits<double>::infinity();
  if (!output_.wants_frames()) return next;
  if (ticked_) return -next;
  if (jumped_) next = next_jump_;
  if (advanced_ || jumped_ || (frame_wanted_ && frames_stand()))
    next = std::min(next, next_idle_frame_);
  return next;
}

bool Room::has_news() const {
  return state_changed_ || roster_changed_ || pins_changed_ || grabs_changed_ || !notices_.empty();
}

/// Changes are announced together, at most once per tick's time, so that no viewer can flood the
/// others by changing something. Long lists of pins are announced less often.
void Room::tell_changes_if_due(double now) {
  if (has_news() && now >= next_telling_) tell_changes();
}

Message Room::state_message() {
  return text_message(proto::encode_state(state()), Topic::state);
}

Message Room::pins_message() {
  return text_message(proto::encode_pins(world_->tick(), pins_of(*world_, holds_)), Topic::pins);
}

Message Room::grabs_message() {
  return text_message(proto::encode_grabs(world_->tick(), grabs_of(*world_, holds_, false)),
                      Topic::grabs);
}

/// During a tick, what is told of the cloth waits for its end.
void Room::tell_changes() {
  std::size_t bytes = 0;
  const auto tell = [&](const Message& message) {
    bytes += message.bytes.size();
    output_.broadcast(message);
  };
  const double now = clock_();
  for (const proto::Notice& notice : std::exchange(notices_, {}))
    tell(text_message(proto::encode_notice(notice)));
  if (roster_changed_) tell(text_message(proto::encode_roster(roster()), Topic::roster));
  roster_changed_ = false;
  if (!in_tick_) {
    if (state_changed_) tell(told_.state = state_message());
    if (state_changed_) next_state_ = now + kStatePause;
    if (pins_changed_) tell(told_.pins = pins_message());
    if (grabs_changed_) tell(told_.grabs = grabs_message());
    state_changed_ = pins_changed_ = grabs_changed_ = false;
  }
  next_telling_ = now + std::max({world_->tick_seconds(), kShortestTelling,
                                  static_cast<double>(bytes) / kTellingRate});
}

/// Sends the newest frame to all viewers for which it is news.
void Room::publish(double now) {
  Frame frame = encode_frame();
  frame.at_once = jumped_;
  // The result of `advance` goes to its viewer as it requested, until something else changes.
  if (!frame_wanted_ && !ticked_) frame.not_to = advance_for_;
  if (jumped_) next_jump_ = now + world_->tick_seconds();
  next_idle_frame_ = now + world_->tick_seconds();
  for (auto& [id, viewer] : viewers_)
    if (id != frame.not_to) viewer.wants_frame = false;
  if (frame.not_to == 0) advance_for_ = 0;
  frame_wanted_ = ticked_ = advanced_ = jumped_ = false;
  output_.offer_frame(std::move(frame));
}

/// Sends a frame to a viewer that lacks the present one.
void Room::show_to(proto::ViewerId viewer) {
  Frame frame = encode_frame();
  frame.at_once = true;
  frame.only_to = viewer;
  viewers_.at(viewer).wants_frame = false;
  output_.offer_frame(std::move(frame));
}

/// A frame of the present state.
Frame Room::encode_frame() {
  measure_forces();
  within_limit([this] { world_->measure_present_forces(); }, kBetweenTicks);
  grab_samples(*world_, holds_, grab_samples_);
  applied_.clear();
  for (const auto& [id, viewer] : viewers_)
    if (viewer.applied > 0) applied_.push_back({id, viewer.applied});

  proto::FrameView view;
  view.header.flags = static_cast<std::uint8_t>(
      proto::kFrameKey | (jumped_ ? proto::kFrameJump : 0) | (paused() ? proto::kFramePaused : 0));
  view.header.tick = world_->tick();
  view.header.time = static_cast<double>(world_->tick()) * world_->tick_seconds();
  view.header.server_time = time_.last_tick_done();
  view.header.sequence = view.header.reference = ++sequence_;
  view.header.epoch = epoch_;
  view.positions = floats_of(world_->state().x);
  view.grabs = grab_samples_;
  view.applied = applied_;
  pose_samples(*world_, pose_samples_);
  view.poses = pose_samples_;
  proto::Bytes bytes, with_forces;
  proto::encode_frame(view, bytes);
  Frame frame{SharedBytes(std::move(bytes)), sequence_};
  if (world_->reactions()) {
    contact_samples_ = contact_samples(*world_);
    reaction_samples_ = reaction_samples(*world_);
    view.contacts = contact_samples_;
    view.reactions = reaction_samples_;
    proto::encode_frame(view, with_forces);
    frame.with_forces = SharedBytes(std::move(with_forces));
  }
  ++frames_encoded_;
  return frame;
}

void Room::notify(proto::NoticeLevel level, const char* code, std::string message,
                  proto::ViewerId viewer, std::optional<std::uint32_t> drag,
                  std::optional<double> value) {
  proto::Notice notice;
  notice.level = level;
  notice.code = code;
  notice.message = std::move(message);
  notice.tick = world_->tick();
  if (viewer != 0) notice.viewer = viewer;
  notice.drag = drag;
  notice.value = value;
  // Keeps only the newest of equal notices that wait.
  std::erase_if(notices_, [&notice](const proto::Notice& told) {
    return told.code == notice.code && told.message == notice.message &&
           told.viewer == notice.viewer && told.drag == notice.drag;
  });
  notices_.push_back(std::move(notice));
}

}  // namespace weft::server
