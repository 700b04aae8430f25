#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "server/message.h"
#include "server/room/holds.h"
#include "server/translate/translate_forces.h"

namespace weft::server {

/// Encodes frames of the present state, and keeps its arrays from one to the next.
class FrameMaker {
 public:
  /// What a frame tells besides the world.
  struct Facts {
    bool jumped = false, paused = false;
    bool forces = false;     ///< a viewer wants them in its frames
    double server_time = 0;  ///< when its tick was done [s]
    std::uint32_t epoch = 0;
  };

  /// Which commands the coming frame includes.
  std::vector<proto::AppliedCommand>& applied() { return applied_; }
  /// Contacts and reactions are in its second encoding, if they are wanted and measured.
  Frame make(const ServedWorld& world, const Holds& holds, const Facts& facts);
  /// One for a single viewer, in the same encoding: `add` gives it what others do not have.
  SharedBytes make_for_one(const ServedWorld& world, const Holds& holds, const Facts& facts,
                           const std::function<void(proto::FrameView&)>& add);
  /// Frames made.
  std::uint64_t count() const { return count_; }

 private:
  proto::FrameView view(const ServedWorld& world, const Holds& holds, const Facts& facts);

  std::uint32_t sequence_ = 0;
  std::uint64_t count_ = 0;
  std::vector<proto::GrabSample> grabs_;
  std::vector<proto::PoseSample> poses_;
  std::vector<proto::AppliedCommand> applied_;
  std::vector<proto::ContactSample> contacts_;
  std::vector<proto::ReactionSample> reactions_;
};

}  // namespace weft::server
