#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "server/room/room.h"

// When a room sends frames and announces changes, and what they contain.

namespace weft::server {
/// Measures contacts and reactions as long as a viewer wants them.
void Room::measure_forces() {
  const bool in_frames = output_.wants_forces() || advance_wants_forces();
  forces_.in_frames = in_frames;
  const bool wanted = in_frames || forces_.asked_at(world_->tick());
  if (wanted == forces_.measured) return;
  forces_.measured = wanted;
  within_limit([this] { world_->measure_forces(forces_.measured); });
}

/// Measures the balance of energy as long as a viewer that has asked for it is here.
void Room::measure_balance() {
  const bool wanted = std::any_of(viewers_.begin(), viewers_.end(),
                                  [](const auto& entry) { return entry.second.wants_balance; });
  if (wanted != (world_->energy_balance() != nullptr)) world_->measure_energy(wanted);
}

void Room::show_to_those_who_lack(double now) {
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.wants_frame) continue;
    show_to(id);
    frames_.sent_to_one(now, world_->tick_seconds());
  }
}

/// Whether ticks make no frames now: the clock makes no ticks, or all cloth sleeps.
bool Room::frames_stand() const {
  return !ticking() || world_->report().rested;
}

/// When a frame to all is due [s]; infinity if no viewer wants one.
double Room::next_frame() const {
  return output_.wants_frames() ? frames_.next(frames_stand())
                                : std::numeric_limits<double>::infinity();
}

void Room::tell_changes_if_due(double now) {
  if (news_.any() && now >= news_.next) tell_changes();
}

/// Notes that something is to be told, and shown.
void Room::change(bool News::*what) {
  news_.*what = true;
  frames_.note_command();
}

/// Takes what viewers are told of the cloth from the world, between two ticks.
void Room::renew_told() {
  told_.state = state_message();
  told_.pins = pins_message();
  told_.grabs = grabs_message();
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

/// Long lists of pins are told less often. During a tick, what is told of the cloth waits for its
/// end.
void Room::tell_changes() {
  std::size_t bytes = 0;
  const auto tell = [&](const Message& message) {
    bytes += message.bytes.size();
    output_.broadcast(message);
  };
  const double now = clock_();
  for (const proto::Notice& notice : std::exchange(news_.notices, {}))
    tell(text_message(proto::encode_notice(notice)));
  if (news_.roster) tell(text_message(proto::encode_roster(roster()), Topic::roster));
  news_.roster = false;
  if (!tick_.runs) {
    if (news_.state) tell(told_.state = state_message());
    if (news_.state) news_.next_state = now + kStatePause;
    if (news_.pins) tell(told_.pins = pins_message());
    if (news_.grabs) tell(told_.grabs = grabs_message());
    news_.state = news_.ticks = news_.pins = news_.grabs = false;
  }
  news_.next = now + std::max({world_->tick_seconds(), kShortestTelling,
                               static_cast<double>(bytes) / kTellingRate});
}

/// Sends the newest frame to all viewers for which it is news.
void Room::publish(double now) {
  Frame frame = encode_frame(frames_.jumped());
  frame.at_once = frame.jump = frames_.jumped();
  // The result of `advance` goes to its viewer as it requested, until something else changes.
  frame.not_to = frames_.excluded();
  frame.owes_jump = frames_.owes_jump();
  frames_.sent(now, world_->tick_seconds());
  for (auto& [id, viewer] : viewers_)
    if (id != frame.not_to) viewer.wants_frame = false;
  output_.offer_frame(std::move(frame));
}

/// Sends a frame to a viewer that lacks the present one.
void Room::show_to(proto::ViewerId viewer) {
  Frame frame = encode_frame(frames_.jumped());
  frame.at_once = true;
  frame.only_to = viewer;
  viewers_.at(viewer).wants_frame = false;
  output_.offer_frame(std::move(frame));
}

/// What a frame of the present state tells besides the world, whose forces are then measured if
/// they are wanted.
FrameMaker::Facts Room::frame_facts(bool jumped) {
  measure_forces();
  if (forces_.in_frames && !world_->reactions())
    within_limit([this] { world_->measure_present_forces(); }, kBetweenTicks);
  std::vector<proto::AppliedCommand>& applied = frame_maker_.applied();
  applied.clear();
  for (const auto& [id, viewer] : viewers_)
    if (viewer.applied > 0) applied.push_back({id, viewer.applied});
  return {jumped, paused(), forces_.in_frames, time_.last_tick_done(), epoch_};
}

/// A frame of the present state.
/// @param jumped  whether it tells that the state was replaced
Frame Room::encode_frame(bool jumped) {
  const FrameMaker::Facts facts = frame_facts(jumped);
  return frame_maker_.make(*world_, holds_, facts);
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
  news_.add(std::move(notice));
}

}  // namespace weft::server
