#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "server/room/refusals.h"
#include "server/room/room.h"
#include "server/translate/translate.h"
#include "server/translate/translate_energy.h"
#include "server/translate/translate_forces.h"

// Answers of a room to queries about its cloth.

namespace weft::server {

using proto::ViewerId;

Room::Outcome Room::query_numbers(const proto::Query& command, std::span<const float> values,
                                  std::uint32_t components) {
  if (command.format == proto::QueryFormat::json)
    return proto::Reply(proto::VectorsReply{world_->tick(), command.what, values, components});
  proto::BinaryReply reply;
  reply.tick = world_->tick();
  reply.what = command.what;
  reply.format = command.format;
  reply.transfer = ++transfers_;
  reply.count = static_cast<std::uint32_t>(values.size() / components);
  reply.components = components;
  const proto::DataHeader header{reply.tick, reply.transfer, components};
  follow_up_ = binary_message(
      command.format == proto::QueryFormat::f64
          ? proto::encode_data(header, std::vector<double>(values.begin(), values.end()))
          : proto::encode_data(header, values));
  return proto::Reply(reply);
}

Room::Outcome Room::query_boxes(const proto::Query& command) {
  const auto boxes =
      world_->debug_boxes(*command.tree, static_cast<int>(command.level.value_or(0)));
  box_values_.clear();
  for (const Aabb<float>& box : boxes) {
    for (const Vec3f& corner : {box.lower, box.upper})
      box_values_.insert(box_values_.end(), corner.data(), corner.data() + 3);
  }
  return query_numbers(command, box_values_, 6);
}

Room::Outcome Room::apply(ViewerId asking, const proto::Query& command) {
  proto::QueryReply reply;
  reply.tick = world_->tick();
  switch (command.what) {
    case proto::QueryWhat::positions:
      return query_numbers(command, floats_of(world_->state().x), 3);
    case proto::QueryWhat::velocities:
      return query_numbers(command, floats_of(world_->state().v), 3);
    case proto::QueryWhat::boxes:
      return query_boxes(command);
    case proto::QueryWhat::energies:
      reply.data = state().energy;
      break;
    case proto::QueryWhat::strain:
      reply.data = state().strain;
      break;
    case proto::QueryWhat::pins:
      reply.data = pins_of(*world_, holds_);
      break;
    case proto::QueryWhat::grabs:
      reply.data = grabs_of(*world_, holds_, true);
      break;
    case proto::QueryWhat::roster:
      reply.data = roster();
      break;
    case proto::QueryWhat::state:
      reply.data = state();
      break;
    case proto::QueryWhat::work:
      reply.data = work_of(*world_);
      break;
    case proto::QueryWhat::colliders:
      reply.data = collider_poses(*world_);
      break;
    case proto::QueryWhat::measurements:
      reply.data = measurements_of(*world_);
      break;
    case proto::QueryWhat::contacts:
      reply.data = contacts_of(*world_, present_reactions());
      break;
    case proto::QueryWhat::reactions: {
      proto::ReactionInfo reactions = reactions_of(*world_, present_reactions());
      for (const proto::GrabInfo& grab : grabs_of(*world_, holds_, true))
        reactions.grabs.push_back({grab.id, grab.viewer, *grab.force});
      reply.data = std::move(reactions);
      break;
    }
    case proto::QueryWhat::crossings:
      if (!within_limit([&] { guarantee_.count(*world_); }, kBetweenTicks)) {
        news_.state = true;  // the guarantee is not held
        throw Stopped();
      }
      reply.data = guarantee_.count(*world_);
      tell_guarantee();
      break;
    case proto::QueryWhat::balance:
      viewers_.at(asking).wants_balance = true;
      measure_balance();
      reply.data = *balance_of(*world_);
      break;
    case proto::QueryWhat::grippers:
      reply.data = grippers_of(*world_);
      break;
    case proto::QueryWhat::trees:
      reply.data = trees_of(*world_);
      break;
    case proto::QueryWhat::camera: {
      if (command.viewer && !viewers_.contains(*command.viewer))
        return unknown_viewer(*command.viewer);
      std::vector<proto::ViewerCamera> cameras;
      for (const auto& [id, viewer] : viewers_) {
        if (viewer.info.camera && (!command.viewer || *command.viewer == id))
          cameras.push_back({id, *viewer.info.camera});
      }
      reply.data = std::move(cameras);
      break;
    }
  }
  return proto::Reply(std::move(reply));
}

/// Those of the last tick. Where it did not measure them, looks one tick ahead, and throws Stopped
/// if that takes more than what is allowed between two ticks. Later ticks do measure them.
const Reactions& Room::present_reactions() {
  forces_.asked_until = world_->tick() + kForcesAskedTicks;
  measure_forces();
  if (!within_limit([this] { world_->measure_present_forces(); }, kBetweenTicks)) throw Stopped();
  return *world_->reactions();
}

/// Announces that the promise of no crossings has ended or is restored.
void Room::tell_guarantee() {
  for (GuaranteeNews& news : guarantee_.take_news()) {
    notify(news.level, news.code, std::move(news.message));
    news_.state = true;
  }
}

}  // namespace weft::server
