#include "server/net/hub.h"

#include <cmath>
#include <string>
#include <utility>

#include "proto/messages/events.h"

namespace weft::server {
namespace {

constexpr std::size_t kKeptMeshes = 4;
constexpr double kNoticePause = 5;          // between two notices of dropped frames [s]
constexpr double kGlancePause = 1;          // between two states for a viewer that glances [s]
constexpr std::uint64_t kDropsToTell = 10;  // fewer are ordinary jitter

}  // namespace

Hub::Hub(Clock clock, double frame_rate, const ChannelLimits& limits, Metrics& metrics)
    : clock_(std::move(clock)), frame_rate_(frame_rate), limits_(limits), metrics_(metrics) {}

ViewerChannel& Hub::add(proto::ViewerId viewer, ViewerStream& stream) {
  Viewer& entry = viewers_[viewer];
  entry.channel = std::make_unique<ViewerChannel>(stream, clock_, frame_rate_, limits_);
  metrics_.set_viewers(static_cast<int>(viewers_.size()));
  return *entry.channel;
}

void Hub::remove(proto::ViewerId viewer) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  count_frames(found->second);
  viewers_.erase(found);
  metrics_.set_viewers(static_cast<int>(viewers_.size()));
  count_takers();
}

void Hub::send(proto::ViewerId viewer, Message message) {
  const auto found = viewers_.find(viewer);
  if (found != viewers_.end()) found->second.channel->send(std::move(message));
}

void Hub::send(proto::ViewerId viewer, std::vector<Message> messages) {
  const auto found = viewers_.find(viewer);
  if (found != viewers_.end()) found->second.channel->send(std::move(messages));
}

void Hub::broadcast(const Message& message) {
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.welcomed) continue;
    if (!viewer.glances)
      viewer.channel->send(message);
    else if (message.topic == Topic::state)
      viewer.state = message;
  }
}

void Hub::welcome_done(proto::ViewerId viewer) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  found->second.welcomed = true;
  found->second.channel->welcome_done();
  count_takers();
}

void Hub::offer_mesh(std::uint64_t hash, SharedBytes bytes, const PackedMesh& packed) {
  packer_.begin(packed);
  for (auto& [id, viewer] : viewers_) {
    viewer.channel->drop_frame();
    viewer.state.reset();
  }
  meshes_.emplace_front(hash, std::move(bytes));
  if (meshes_.size() > kKeptMeshes) meshes_.pop_back();
}

void Hub::offer_frame(const Frame& frame) {
  for (auto& [id, viewer] : viewers_) {
    if (frame.only_to != 0 && id != frame.only_to) continue;
    if (id != frame.not_to)
      viewer.channel->offer_frame(frame);
    else if (frame.owes_jump)
      viewer.channel->owe_jump();
  }
}

void Hub::set_frame_rate(double frame_rate) {
  frame_rate_ = frame_rate;
  for (auto& [id, viewer] : viewers_) viewer.channel->set_frame_rate(frame_rate);
}

void Hub::set_most_frames(proto::ViewerId viewer, double hz) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  found->second.channel->set_most_frames(hz);
  count_takers();
}

void Hub::want_forces(proto::ViewerId viewer, bool wanted) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  found->second.channel->want_forces(wanted);
  count_takers();
}

void Hub::set_role(proto::ViewerId viewer, proto::Role role) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  found->second.role = role;
  if (role == proto::Role::viewer) want_forces(viewer, false);
}

proto::Role Hub::role(proto::ViewerId viewer) const {
  const auto found = viewers_.find(viewer);
  return found == viewers_.end() ? proto::Role::viewer : found->second.role;
}

void Hub::set_glance(proto::ViewerId viewer) {
  const auto found = viewers_.find(viewer);
  if (found != viewers_.end()) found->second.glances = true;
}

void Hub::want_packed(proto::ViewerId viewer, double usual, double most) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  found->second.channel->pack_with(packer_, usual, most);
  count_takers();
}

void Hub::poll() {
  for (auto& [id, viewer] : viewers_) {
    viewer.channel->poll();
    count_frames(viewer);
    tell_state(viewer);
    tell_dropped(viewer);
    tell_quality(viewer);
  }
}

void Hub::close_all(std::uint16_t code, const std::string& reason, const Message& last) {
  for (auto& [id, viewer] : viewers_) viewer.channel->close(code, reason, last);
}

SharedBytes Hub::find_mesh(std::uint64_t hash) const {
  for (const auto& [known, bytes] : meshes_)
    if (known == hash) return bytes;
  return {};
}

void Hub::count_takers() {
  int takers = 0, force_takers = 0, packed_takers = 0;
  for (const auto& [id, viewer] : viewers_) {
    takers += viewer.channel->wants_frames() ? 1 : 0;
    force_takers += viewer.channel->wants_forces() ? 1 : 0;
    packed_takers += viewer.channel->packed_error() > 0 ? 1 : 0;
  }
  frame_takers_.store(takers, std::memory_order_relaxed);
  force_takers_.store(force_takers, std::memory_order_relaxed);
  if (packed_takers == 0) packer_.forget();
}

void Hub::count_frames(Viewer& viewer) {
  const std::uint64_t sent = viewer.channel->frames_sent();
  const std::uint64_t dropped = viewer.channel->frames_dropped();
  metrics_.count_frames(sent - std::exchange(viewer.sent_counted, sent),
                        dropped - std::exchange(viewer.dropped_counted, dropped));
}

void Hub::tell_state(Viewer& viewer) {
  const double now = clock_();
  if (!viewer.state || now < viewer.next_state) return;
  viewer.next_state = now + kGlancePause;
  viewer.channel->send(*std::exchange(viewer.state, std::nullopt));
}

void Hub::tell_dropped(Viewer& viewer) {
  const double now = clock_();
  if (!viewer.welcomed || now < viewer.next_notice) return;
  viewer.next_notice = now + kNoticePause;
  const std::uint64_t dropped = viewer.channel->take_dropped();
  if (dropped < kDropsToTell) return;
  proto::Notice notice;
  notice.level = proto::NoticeLevel::warning;
  notice.code = "frames_dropped";
  notice.message = std::to_string(dropped) + " frames were dropped for this viewer";
  notice.count = dropped;
  viewer.channel->send(text_message(proto::encode_notice(notice)));
}

void Hub::tell_quality(Viewer& viewer) {
  const auto now = viewer.channel->take_change();
  if (!now) return;
  proto::Notice notice;
  notice.code = "quality";
  notice.message =
      "this viewer gets " + proto::number_text(std::round(now->hz)) + " frames a second" +
      (now->error > 0 ? " within " + proto::number_text(now->error) + " m" : std::string()) +
      ": as many as it keeps up with";
  notice.value = now->hz;
  viewer.channel->send(text_message(proto::encode_notice(notice)));
}

}  // namespace weft::server
