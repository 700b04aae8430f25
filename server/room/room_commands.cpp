#include <algorithm>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/world/cost.h"
#include "server/room/refusals.h"
#include "server/room/room.h"
#include "server/translate/translate.h"
#include "server/translate/translate_holds.h"

// What each command does. A function either applies its command and returns the reply, or changes
// nothing and returns the error.

namespace weft::server {
namespace {

using proto::ErrorCode;
using proto::make_error;
using proto::ViewerId;

}  // namespace

void Room::handle(ViewerId viewer, const proto::Request& request) {
  const std::uint64_t tick = world_->tick();
  metrics_.count_command(proto::name_of(request.command));
  const Viewer& sender = viewers_.at(viewer);
  if (auto error = check_right(request.command, sender.info.role, may_hold(sender)))
    return refuse(viewer, request, *std::move(error));
  try {
    const Outcome outcome =
        std::visit([&](const auto& command) { return apply(viewer, command); }, request.command);
    if (!outcome) return refuse(viewer, request, outcome.error());
    if (std::holds_alternative<proto::Load>(request.command) ||
        std::holds_alternative<proto::CreateRoom>(request.command)) {
      order_.building->request = request;  // it is logged and answered when finished
      return finish_build();
    }
    // What only looks is no part of the history, and its viewers cannot fill the log.
    if (!is_about_rooms(request.command) && proto::right_to(request.command) != proto::Right::look)
      order_.log.add(tick, viewer, CommandOrigin::viewer, request.command);
    if (std::holds_alternative<proto::Advance>(request.command)) {
      order_.advance->id = request.id;  // answered when it is done
      return;
    }
    answer(viewer, request.id, *outcome);
  } catch (const DefinitionError& error) {
    refuse(viewer, request, to_wire(error));
  } catch (const Stopped&) {
    refuse(viewer, request,
           make_error(ErrorCode::too_costly,
                      "looking one tick ahead takes more than the limit of CPU time",
                      "ask when less of the cloth is in contact"));
  } catch (const std::exception& error) {
    spdlog::error("command {}: {}", proto::name_of(request.command), error.what());
    refuse(viewer, request, make_error(ErrorCode::internal, "the server failed at this command"));
  }
  follow_up_.reset();
}

void Room::answer(ViewerId viewer, const std::optional<proto::Id>& id, const proto::Reply& reply) {
  if (!id) return;
  output_.send(viewer, text_message(proto::encode_reply(*id, reply)));
  if (follow_up_) output_.send(viewer, *std::exchange(follow_up_, std::nullopt));
}

void Room::refuse(ViewerId viewer, const proto::Request& request, proto::Error error) {
  metrics_.count_error(proto::name_of(error.code));
  error.command = proto::name_of(request.command);
  error.id = request.id;
  output_.send(viewer, text_message(proto::encode_error(error)));
}

Room::Outcome Room::apply(ViewerId, const proto::Pick& command) {
  const auto hit = world_->pick(from_wire(command.origin), from_wire(command.direction));
  return proto::Reply(proto::PickReply{world_->tick(), to_wire(hit)});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::DragStart& command) {
  proto::ServerLimits limits = options_.limits;
  limits.drags_per_viewer = most_hands(rights_.policy, limits.drags_per_viewer);
  if (auto error = check_new_hand(holds_, viewer, command.drag, limits)) return *std::move(error);
  const auto point = resolve_hold(*world_, command.hold);
  if (!point) return point.error();
  const GrabDef def = grab_def(*world_, command, *point);
  if (auto error = check_shared_hold(viewer, nearest_corner(*world_, *point), def.radius, 0))
    return *std::move(error);
  const GrabId grab = world_->grab(def);
  holds_.add({grab, viewer, command.drag, clock_()});
  change(&News::grabs);
  return proto::Reply(
      proto::DragReply{world_->tick(), command.drag, grab, to_wire(def.target), {}});
}

/// Why a viewer may not hold so much there; nothing if it may.
/// @param pinned  particles that it has pinned already, if it pins
std::optional<proto::Error> Room::check_shared_hold(ViewerId viewer, Index particle, double radius,
                                                    std::size_t pinned) const {
  const Viewer& self = viewers_.at(viewer);
  // An operator by its token takes hold beside the hands of others.
  auto error = leads(self) ? std::nullopt : check_free(holds_, *world_, viewer, particle);
  const bool shares = self.info.role == proto::Role::viewer && viewers() > 1;
  if (!error && shares) error = check_width(*world_, particle, radius, pinned);
  return error;
}

Room::Outcome Room::apply(ViewerId viewer, const proto::DragMove& command) {
  Hand* const hand = holds_.find(viewer, command.drag);
  if (!hand) return unknown_drag(command.drag, "start it; its lease may have ended it");
  const Vec3d target = from_wire(command.target);
  const auto& grabs = world_->grabs().list;
  const auto grab = std::find_if(grabs.begin(), grabs.end(),
                                 [&](const Grab<float>& g) { return g.id == hand->grab; });
  // A hand at rest repeats its target, which changes nothing.
  if (grab == grabs.end() || grab->target != target.cast<float>()) frames_.note_command();
  world_->move_grab(hand->grab, target);
  hand->heard = clock_();
  return proto::Reply(proto::DragReply{world_->tick(), command.drag, hand->grab, {}, {}});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::DragEnd& command) {
  const Hand* const hand = holds_.find(viewer, command.drag);
  if (!hand) return unknown_drag(command.drag);
  proto::DragReply reply{world_->tick(), command.drag, hand->grab, {}, {}};
  if (const auto impulse = command.fire ? world_->fire(hand->grab) : std::nullopt)
    reply.impulse = to_wire(*impulse);
  else
    world_->release(hand->grab);
  holds_.remove(hand->grab);
  change(&News::grabs);
  return proto::Reply(reply);
}

void Room::end_hand(const Hand& hand, CommandOrigin origin) {
  order_.log.add(world_->tick(), hand.viewer, origin, proto::DragEnd{hand.drag});
  world_->release(hand.grab);
  holds_.remove(hand.grab);
  change(&News::grabs);
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Pin& command) {
  const auto point = resolve_hold(*world_, command.hold);
  if (!point) return point.error();
  if (world_->pins().list.size() >= options_.limits.pins)
    return too_many("pins", options_.limits.pins);
  const Index particle = nearest_corner(*world_, *point);
  const std::size_t pinned = pinned_particles(*world_, holds_, viewer);
  if (auto error = check_shared_hold(viewer, particle, command.radius, pinned))
    return *std::move(error);
  const PinId pin = world_->pin({particle, command.radius, {}});
  holds_.own(pin, viewer);
  change(&News::pins);
  const auto count = static_cast<std::uint32_t>(world_->pins().list.back().particles.size());
  return proto::Reply(
      proto::PinReply{world_->tick(), pin, static_cast<std::uint32_t>(particle), count});
}

Room::Outcome Room::release_pins(const std::vector<std::uint32_t>& ids) {
  world_->unpin(ids);
  for (const std::uint32_t id : ids) holds_.disown(id);
  if (!ids.empty()) change(&News::pins);
  return proto::Reply(proto::ReleaseReply{world_->tick(), ids});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::ReleasePin& command) {
  if (find_pin(*world_, command.pin) == nullptr) return unknown_pin(command.pin);
  if (auto error = check_owner(viewer, command.pin)) return *std::move(error);
  return release_pins({command.pin});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::ReleaseParticle& command) {
  const std::size_t count = world_->model().mass.size();
  if (command.particle >= count)
    return proto::range_error("particle", command.particle, {0, static_cast<double>(count) - 1});
  std::vector<std::uint32_t> ids;
  for (const weft::Pin& pin : world_->pins().list) {
    if (std::binary_search(pin.particles.begin(), pin.particles.end(),
                           static_cast<Index>(command.particle)))
      ids.push_back(pin.id);
  }
  for (const PinId pin : ids)
    if (auto error = check_owner(viewer, pin)) return *std::move(error);
  return release_pins(ids);
}

Room::Outcome Room::apply(ViewerId, const proto::ReleaseAll&) {
  std::vector<std::uint32_t> ids;
  for (const weft::Pin& pin : world_->pins().list) ids.push_back(pin.id);
  return release_pins(ids);
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Camera& command) {
  viewers_.at(viewer).info.camera = command;
  viewers_.at(viewer).presence.look(command);
  news_.presence = true;
  return proto::Reply(proto::DoneReply{"camera", world_->tick()});
}

Room::Outcome Room::apply(ViewerId, const proto::Pause&) {
  if (!paused()) frames_.note_command();
  time_.pause();
  news_.state = true;
  if (order_.advance) order_.advance->paused = true;
  if (order_.advance && !tick_.runs) end_paused_advance();
  // The tick under way ends before the cloth stands.
  return proto::Reply(proto::PauseReply{tick_.runs ? tick_.until : world_->tick(), true});
}

Room::Outcome Room::apply(ViewerId, const proto::Resume&) {
  if (paused()) frames_.note_command();
  time_.resume(clock_());
  news_.state = true;
  return proto::Reply(proto::PauseReply{world_->tick(), false});
}

Room::Outcome Room::apply(ViewerId, const proto::Step& command) {
  if (order_.advance) return advancing_error();
  if (!paused()) return not_paused();
  time_.add_steps(command.n, clock_());
  return proto::Reply(proto::StepReply{world_->tick(), world_->tick() + time_.steps_left()});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Reset&) {
  if (order_.advance) end_advance(ErrorCode::interrupted, "a viewer sent reset", "");
  world_->reset();
  tell_jump("reset", "the cloth is back at its start", viewer);
  guarantee_.restart();
  tell_guarantee();
  return proto::Reply(proto::DoneReply{"reset", world_->tick()});
}

/// The state is another one than after the last tick: no viewer holds anything, and all is told.
void Room::tell_jump(const char* code, std::string message, ViewerId viewer) {
  holds_.clear();
  told_.restart();
  time_.drop_steps();
  news_.replace();
  frames_.note_jump();
  notify(proto::NoticeLevel::info, code, std::move(message), viewer);
}

/// Without the hands of viewers: these may hold something else when it is restored.
Room::Outcome Room::apply(ViewerId, const proto::Save& command) {
  if (auto error = saves_.check(command.name, world_->model().mass.size()))
    return *std::move(error);
  std::unique_ptr<ServedWorld> kept = world_->fork();
  for (const Hand& hand : holds_.hands()) kept->release(hand.grab);
  saves_.keep(command.name, {std::move(kept), guarantee_, mesh_, forces_, holds_.pin_owners(),
                             time_.wanted_softness()});
  return proto::Reply(proto::DoneReply{"save", world_->tick()});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Restore& command) {
  const auto found = saves_.find(command.name);
  if (!found) return found.error();
  const weft::server::Save& save = **found;
  if (options_.others) {  // whose rooms may have taken since what this one cost then
    const TickCost cost = save.world->cost_in(save.world->environment());
    if (auto error = options_.others->admit(options_.name, cost)) return *std::move(error);
  }
  if (order_.advance) end_advance(ErrorCode::interrupted, "a viewer sent restore", "");
  world_ = save.world->fork();
  mesh_ = save.mesh;
  guarantee_ = save.guarantee;
  forces_ = save.forces;
  time_.restore_softness(save.wanted_softness, world_->softness());
  tell_jump("restored", "the cloth is back in its state " + command.name, viewer);
  for (const auto& [pin, owner] : save.pin_owners) holds_.own(pin, owner);
  tell_guarantee();
  return proto::Reply(proto::DoneReply{"restore", world_->tick()});
}

Room::Outcome Room::apply(ViewerId, const proto::Speed& command) {
  time_.set_speed(command.speed);
  follow_speed();
  news_.state = true;
  return proto::Reply(proto::SpeedReply{world_->tick(), time_.wanted_speed()});
}

Room::Outcome Room::apply(ViewerId, const proto::Move& command) {
  const auto collider = find_collider(*world_, command.collider);
  if (!collider) return collider.error();
  world_->move_collider(*collider, move_def(*world_, *collider, command));
  return proto::Reply(proto::MoveReply{world_->tick(), command.collider});
}

Room::Outcome Room::apply(ViewerId, const proto::MoveEnd& command) {
  const auto collider = find_collider(*world_, command.collider);
  if (!collider) return collider.error();
  world_->release_collider(*collider);
  return proto::Reply(proto::MoveReply{world_->tick(), command.collider});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::MovePin& command) {
  const weft::Pin* pin = find_pin(*world_, command.pin);
  if (pin == nullptr) return unknown_pin(command.pin);
  if (auto error = check_owner(viewer, command.pin)) return *std::move(error);
  const auto move = pin_move(*world_, *pin, command);
  if (!move) return move.error();
  const proto::Vec3 before = pin_info(*world_, *pin, 0).position;
  world_->move_pin(pin->id, *move);
  note_pins(*world_, told_);
  change(&News::pins);
  return proto::Reply(proto::MovePinReply{world_->tick(), command.pin, before});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::StopPin& command) {
  const weft::Pin* pin = find_pin(*world_, command.pin);
  if (pin == nullptr) return unknown_pin(command.pin);
  if (auto error = check_owner(viewer, command.pin)) return *std::move(error);
  world_->stop_pin(pin->id);
  note_pins(*world_, told_);
  change(&News::pins);
  return proto::Reply(
      proto::MovePinReply{world_->tick(), command.pin, pin_info(*world_, *pin, 0).position});
}

Room::Outcome Room::apply(ViewerId, const proto::Gripper& command) {
  const auto gripper = find_gripper(*world_, command.gripper);
  if (!gripper) return gripper.error();
  world_->command_gripper(*gripper, gripper_command(command));
  return proto::Reply(proto::GripperReply{world_->tick(), command.gripper});
}

Room::Outcome Room::apply(ViewerId viewer, const proto::Advance& command) {
  if (order_.advance) return advancing_error();
  if (!paused()) return not_paused();
  if (time_.steps_left() > 0)
    return make_error(ErrorCode::busy, "a step is still running", "wait for its end or send pause");
  Viewer& caller = viewers_.at(viewer);
  caller.stalled = caller.stalled && frames_wait(caller);
  const bool shown = command.chooses_frames();
  if (caller.stalled && shown) return stalled_error();
  order_.advance = Advance{viewer, std::nullopt, command.n, command, clock_()};
  frames_.begin_advance(shown ? viewer : 0);
  return proto::Reply(proto::AdvanceReply{});
}

Room::Outcome Room::apply(ViewerId, const proto::Hash&) {
  const std::uint64_t hash = tick_.runs ? world_->hash_before_tick() : world_->hash();
  return proto::Reply(proto::HashReply{world_->tick(), hash});
}

/// Sent by the room itself; only a replayed log contains it.
Room::Outcome Room::apply(ViewerId, const proto::Halt&) {
  world_->halt();
  return proto::Reply(proto::DoneReply{"halt", world_->tick()});
}

Room::Outcome Room::apply(ViewerId, const proto::Ping&) {
  return make_error(ErrorCode::internal, "ping is answered by the session");
}

Room::Outcome Room::apply(ViewerId, const proto::View&) {
  return make_error(ErrorCode::internal, "view is answered by the session");
}

}  // namespace weft::server
