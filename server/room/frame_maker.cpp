#include "server/room/frame_maker.h"

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

SharedBytes FrameMaker::make_for_one(const ServedWorld& world, const Holds& holds,
                                     const Facts& facts,
                                     const std::function<void(proto::FrameView&)>& add) {
  proto::FrameView view = this->view(world, holds, facts);
  add(view);
  proto::Bytes bytes;
  proto::encode_frame(view, bytes);
  return SharedBytes(std::move(bytes));
}

}  // namespace weft::server
