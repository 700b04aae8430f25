// Who is in a room and may do what: viewers that come and go, their rights, and the policy.

#include <algorithm>
#include <array>

#include "server/room/refusals.h"
#include "server/room/room.h"

namespace weft::server {

using proto::Policy;
using proto::Role;
using proto::ViewerId;

namespace {

constexpr std::array<const char*, 8> kColors = {"#e4572e", "#2e86e4", "#2ea84f", "#b04fd1",
                                                "#d99a00", "#00a3a3", "#d13f7c", "#6b7a1f"};

const char* describe(Policy policy) {
  switch (policy) {
    case Policy::watch:
      return "only viewers with a hand that was given may hold the cloth now";
    case Policy::one_hand:
      return "everybody may hold the cloth with one hand now";
    case Policy::everybody:
      return "everybody may hold the cloth now";
  }
  return "";
}

}  // namespace

void Room::join(ViewerId id, const Join& join) {
  if (rests() && !join.glances) time_.restart_meter(clock_());
  Viewer& viewer = viewers_[id];
  viewer.glances = join.glances;
  if (join.glances) {
    ++glances_;
    output_.set_glance(id);
  }
  viewer.info.id = id;
  viewer.info.name = "viewer " + std::to_string(id);
  viewer.info.color = kColors[id % kColors.size()];
  viewer.mesh_over_http = join.mesh_over_http;
  admit(viewer, join.grant);
  if (options_.linked && !join.glances && viewers() > kMostUnasked) ask_newcomer(viewer);
  tell_changes_if_due(clock_());
  welcome(id, viewer);
}

/// Newcomers to a crowded room that others reach look until they are given a hand, unless an
/// operator has decided who may hold. Without a token they are no operators either.
void Room::ask_newcomer(Viewer& viewer) {
  if (!viewer.by_token) viewer.info.role = Role::viewer;
  if (viewer.info.role != Role::viewer) return;
  if (!rights_.chosen && viewer.hand == HandRight::by_policy) viewer.hand = HandRight::waiting;
  output_.set_role(viewer.info.id, Role::viewer);
}

/// A mute stays with its token when its viewer leaves or takes another: the next one with it has
/// it.
void Room::leave_mute(const Viewer& viewer) {
  const bool muted = viewer.hand == HandRight::muted && !viewer.glances;
  if (muted && viewer.token != 0) ++rights_.muted_away[viewer.token];
}

/// Whether a token comes muted: it was left so, or is that of a person that is.
bool Room::comes_muted(const Grant& grant) {
  if (grant.token == 0) return false;
  const auto away = rights_.muted_away.find(grant.token);
  if (away != rights_.muted_away.end()) {
    if (--away->second == 0) rights_.muted_away.erase(away);
    return true;
  }
  return !grant.name.empty() &&
         std::any_of(viewers_.begin(), viewers_.end(), [&](const auto& entry) {
           const Viewer& other = entry.second;
           return other.token == grant.token && other.hand == HandRight::muted && !other.glances;
         });
}

/// Notes whose token a viewer has, unless it has told it before. A glance takes no mute along.
void Room::take_token(Viewer& viewer, const Grant& grant) {
  viewer.maker = grant.maker;
  if (viewer.glances || viewer.token == grant.token) return;
  leave_mute(viewer);
  if (comes_muted(grant)) viewer.hand = HandRight::muted;
  viewer.token = grant.token;
  viewer.named = !grant.name.empty();
  if (viewer.named) take_pins_back(viewer);
}

/// A person that has left and comes back with the same token has its pins again.
void Room::take_pins_back(const Viewer& viewer) {
  const auto left = rights_.left_as.find(viewer.token);
  if (left == rights_.left_as.end()) return;
  if (holds_.pass_pins(left->second, viewer.info.id)) change(&News::pins);
  rights_.left_as.erase(left);
}

/// Gives a viewer what its token grants. Its hand is what became of it since, if it tells that
/// token again; and one that waits for a hand waits on if the token grants none.
void Room::admit(Viewer& viewer, const Grant& grant) {
  const bool again = grant.token != 0 && grant.token == viewer.token;
  const bool waits = viewer.hand == HandRight::waiting && grant.role == Role::viewer &&
                     grant.hand == HandRight::by_policy;
  take_token(viewer, grant);
  viewer.info.role = grant.role;
  viewer.by_token = grant.by_token;
  viewer.by_link = !grant.room.empty();
  if (!again && !waits && viewer.hand != HandRight::muted) viewer.hand = grant.hand;
  if (!grant.name.empty()) viewer.info.name = grant.name;
  if (viewer.glances) {
    viewer.info.role = Role::viewer;
    viewer.hand = HandRight::muted;
  }
  output_.set_role(viewer.info.id, viewer.info.role);
  let_go_forbidden(viewer.info.id);
  news_.roster = news_.roster || !viewer.glances;
}

void Room::leave(ViewerId viewer) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  const bool glanced = found->second.glances;
  leave_mute(found->second);
  if (found->second.named && !glanced) rights_.left_as[found->second.token] = viewer;
  viewers_.erase(found);
  if (glanced) {
    --glances_;
    return;
  }
  for (const Hand& hand : holds_.of(viewer)) end_hand(hand, CommandOrigin::leave);
  for (auto& [id, other] : viewers_)
    if (other.presence.follows == viewer) other.presence.follow(0);
  news_.roster = news_.presence = true;
  if (!options_.has_tokens) pass_on_operation();
}

/// Where nobody has a token, a room is never without an operator: the viewer that has been there
/// for longest becomes one.
void Room::pass_on_operation() {
  const bool operated = std::any_of(viewers_.begin(), viewers_.end(), [](const auto& entry) {
    return entry.second.info.role != Role::viewer;
  });
  if (operated) return;
  const auto oldest = std::find_if(viewers_.begin(), viewers_.end(), [](const auto& entry) {
    return !entry.second.by_token && !entry.second.glances;
  });
  if (oldest == viewers_.end()) return;
  oldest->second.info.role = Role::operator_;
  output_.set_role(oldest->first, Role::operator_);
}

bool Room::may_hold(const Viewer& viewer) const {
  return server::may_hold(viewer.hand, rights_.policy, leads(viewer));
}

/// Whether it is an operator by its token, as a teacher is.
bool Room::leads(const Viewer& viewer) const {
  return viewer.by_token && viewer.info.role != Role::viewer;
}

/// Whether it can change nothing.
bool Room::only_looks(const Viewer& viewer) const {
  return viewer.info.role == Role::viewer && !may_hold(viewer);
}

/// Lets go what a viewer may not hold any more; of several hands the oldest stay.
void Room::let_go_forbidden(ViewerId viewer) {
  const bool holds = may_hold(viewers_.at(viewer));
  const std::size_t most = holds ? most_hands(rights_.policy, options_.limits.drags_per_viewer) : 0;
  std::vector<Hand> hands = holds_.of(viewer);  // the latest first
  for (std::size_t k = 0; k + most < hands.size(); ++k) end_hand(hands[k], CommandOrigin::policy);
}

/// Why a viewer may not touch a pin: only operators may touch those of others.
std::optional<proto::Error> Room::check_owner(ViewerId viewer, PinId pin) const {
  const ViewerId owner = holds_.owner(pin);
  if (viewers_.at(viewer).info.role != Role::viewer || owner == viewer) return std::nullopt;
  proto::Error error =
      owner == 0 ? field_error(proto::ErrorCode::not_allowed, "this pin is the scene's own", "pin",
                               pin, "an operator can move or release it")
                 : field_error(proto::ErrorCode::not_allowed, "another viewer set this pin", "pin",
                               pin, "its owner or an operator can move or release it");
  error.limit = proto::Limit{{}, {}, {}, {"operator", "admin"}};
  if (owner != 0) error.limit->allowed.insert(error.limit->allowed.begin(), "owner");
  return error;
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Hello& command) {
  Viewer& self = viewers_.at(viewer);
  const bool changes = (command.name && *command.name != self.info.name) ||
                       (command.color && *command.color != self.info.color);
  if (changes && self.info.role == Role::viewer && clock_() < self.next_name)
    return proto::make_error(proto::ErrorCode::rate_limited, "a name may change once a second",
                             "all viewers are told of it");
  if (changes) self.next_name = clock_() + kNamePause;
  if (command.name) self.info.name = *command.name;
  if (command.color) self.info.color = *command.color;
  news_.roster = news_.roster || !self.glances;
  return proto::Reply(proto::HelloReply{viewer, self.info.name, self.info.color, self.info.role});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::SetPolicy& command) {
  const bool news = rights_.policy != command.policy;
  rights_.policy = command.policy;
  rights_.chosen = true;
  for (auto& [id, other] : viewers_)
    if (other.hand == HandRight::waiting) other.hand = HandRight::by_policy;
  // Who tells others to watch has something to show.
  HandRight& own = viewers_.at(viewer).hand;
  if (command.policy == Policy::watch && own == HandRight::by_policy) own = HandRight::given;
  for (const auto& [id, other] : viewers_) let_go_forbidden(id);
  news_.roster = true;
  change(&News::state);
  if (news) notify(proto::NoticeLevel::info, "policy", describe(command.policy), viewer);
  return proto::Reply(proto::DoneReply{"policy", world_->tick()});
}

/// Changes the right of a viewer to hold: sets it, or takes it back to the policy if it is set.
std::optional<proto::Error> Room::set_hand(ViewerId by, ViewerId viewer, HandRight right,
                                           bool set) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end() || found->second.glances) return unknown_viewer(viewer);
  Viewer& other = found->second;
  if (other.info.role > viewers_.at(by).info.role)
    return field_error(proto::ErrorCode::not_allowed, "this viewer is an admin", "viewer", viewer,
                       "only an admin can do this");
  if (set)
    other.hand = right;
  else if (other.hand == right)
    other.hand = HandRight::by_policy;
  let_go_forbidden(viewer);
  if (other.named) follow_person(other);
  news_.roster = true;
  return std::nullopt;
}

/// A person is muted by every connection with its token or by none, also those to come.
void Room::follow_person(const Viewer& changed) {
  const bool muted = changed.hand == HandRight::muted;
  if (!muted) rights_.muted_away.erase(changed.token);
  for (auto& [id, other] : viewers_) {
    if (other.token != changed.token || other.glances) continue;
    if (muted == (other.hand == HandRight::muted)) continue;
    other.hand = muted ? HandRight::muted : HandRight::by_policy;
    let_go_forbidden(id);
  }
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Mute& command) {
  if (auto error = set_hand(viewer, command.viewer, HandRight::muted, command.muted))
    return *std::move(error);
  return proto::Reply(proto::DoneReply{"mute", world_->tick()});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::GiveHand& command) {
  if (auto error = set_hand(viewer, command.viewer, HandRight::given, command.given))
    return *std::move(error);
  return proto::Reply(proto::DoneReply{"give_hand", world_->tick()});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Presence& command) {
  Viewer& self = viewers_.at(viewer);
  if (command.cursor || command.away) self.presence.point(command.cursor);
  if (command.camera) {
    self.info.camera = command.camera;
    self.presence.look(*command.camera);
  }
  news_.presence = true;
  return proto::Reply(proto::DoneReply{"presence", world_->tick()});
}

/// Tells a camera to those that have begun to see by it.
void Room::show_camera(ViewerId viewer) {
  viewers_.at(viewer).presence.camera_news = true;
  news_.presence = true;
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Follow& command) {
  if (command.viewer != 0 && !viewers_.contains(command.viewer))
    return unknown_viewer(command.viewer);
  Presence& own = viewers_.at(viewer).presence;
  const ViewerId followed = command.viewer == viewer ? 0 : command.viewer;
  own.stays = followed == 0 && (own.stays || own.follows != 0);
  own.follow(followed);
  if (followed != 0) show_camera(followed);
  news_.presence = true;
  return proto::Reply(proto::DoneReply{"follow", world_->tick()});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Lead& command) {
  viewers_.at(viewer).presence.follow(0);
  for (auto& [id, other] : viewers_) {
    Presence& presence = other.presence;
    if (id == viewer) continue;
    if (command.on && !presence.stays) presence.follow(viewer);
    if (!command.on && presence.follows == viewer) presence.follow(0);
  }
  show_camera(viewer);
  if (command.on)
    notify(proto::NoticeLevel::info, "lead", viewers_.at(viewer).info.name + " shows its view",
           viewer);
  return proto::Reply(proto::DoneReply{"lead", world_->tick()});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Invite& command) {
  if (!options_.make_token)
    return proto::make_error(proto::ErrorCode::not_supported, "this server makes no links");
  const bool operates = command.right == proto::Invitation::operate;
  if (operates && options_.has_tokens && viewers_.at(viewer).info.role != Role::admin) {
    proto::Error error = proto::make_error(proto::ErrorCode::not_allowed,
                                           "only an admin may make operators", "invite to hold");
    error.field = "right";
    error.value = proto::quoted_value(proto::name_of(command.right));
    error.limit = proto::Limit{{}, {}, {}, {proto::name_of(Role::admin)}};
    return error;
  }
  const HandRight hand =
      command.right == proto::Invitation::look ? HandRight::muted : HandRight::given;
  const Role role = operates ? Role::operator_ : Role::viewer;
  return proto::Reply(proto::InviteReply{
      world_->tick(),
      options_.make_token({role, hand, "", true, options_.name, 0, maker_of(viewer)})});
}

/// Tells who points and looks where, within the rate that many hands may cost each viewer.
void Room::tell_presence(double now) {
  std::vector<Present> all;
  for (auto& [id, viewer] : viewers_)
    if (!viewer.glances) all.push_back({id, &viewer.presence});
  const auto told = take_news(all, now, news_.presence);
  if (told.empty()) return;
  const Message message = text_message(proto::encode_presence(told));
  const double bytes = static_cast<double>(message.bytes.size());
  news_.next_presence = now + std::max(kPresencePause, bytes / kPresenceRate);
  output_.broadcast(message);
}

std::vector<proto::ViewerInfo> Room::roster() const {
  std::vector<proto::ViewerInfo> list;
  for (const auto& [id, viewer] : viewers_) {
    if (viewer.glances) continue;
    list.push_back(viewer.info);
    list.back().hand = may_hold(viewer);
  }
  return list;
}

}  // namespace weft::server
