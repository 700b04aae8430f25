#include "server/room/frame_maker.h"

#include <algorithm>
#include <utility>

namespace weft::server {

/// Of arrays that last until the next frame; without forces.
proto::FrameView FrameMaker::view(const ServedWorld& world, const Holds& holds,
                                  const Facts& facts) {
  grab_samples(world, holds, grabs_);
  pose_samples(world, poses_);
  proto::FrameView view;
  view.header.flags =
      static_cast<std::uint8_t>(proto::kFrameKey | (facts.jumped ? proto::kFrameJump : 0) |
                                (facts.paused ? proto::kFramePaused : 0));
  view.header.tick = world.tick();
  view.header.time = static_cast<double>(world.tick()) * world.tick_seconds();
  view.header.server_time = facts.server_time;
  view.header.sequence = view.header.reference = ++sequence_;
  view.header.epoch = facts.epoch;
  view.positions = floats_of(world.state().x);
  view.grabs = grabs_;
  view.applied = applied_;
  view.poses = poses_;
  if (facts.forces && world.reactions()) {
    contacts_ = contact_samples(world);
    reactions_ = reaction_samples(world);
  }
  ++count_;
  return view;
}

Frame FrameMaker::make(const ServedWorld& world, const Holds& holds, const Facts& facts) {
  proto::FrameView view = this->view(world, holds, facts);
  proto::Bytes bytes, with_forces;
  proto::encode_frame(view, bytes);
  Frame frame{SharedBytes(std::move(bytes)), sequence_};
  if (facts.forces && world.reactions()) {
    view.contacts = contacts_;
    view.reactions = reactions_;
    proto::encode_frame(view, with_forces);
    frame.with_forces = SharedBytes(std::move(with_forces));
  }
  return frame;
}

SharedBytes FrameMaker::make_observed(const ServedWorld& world, const Holds& holds,
                                      const Facts& facts,
                                      const std::vector<proto::Observed>& observe) {
  const auto observes = [&observe](proto::Observed what) {
    return std::find(observe.begin(), observe.end(), what) != observe.end();
  };
  proto::FrameView view = this->view(world, holds, facts);
  view.header.flags |= proto::kFrameObserved;
  if (observes(proto::Observed::velocities)) view.velocities = floats_of(world.state().v);
  if (world.reactions() && observes(proto::Observed::contacts)) view.contacts = contacts_;
  if (world.reactions() && observes(proto::Observed::reactions)) view.reactions = reactions_;
  if (observes(proto::Observed::grippers)) {
    grippers_ = gripper_samples(world);
    view.grippers = grippers_;
  }
  proto::Bytes bytes;
  proto::encode_frame(view, bytes);
  return SharedBytes(std::move(bytes));
}

}  // namespace weft::server
