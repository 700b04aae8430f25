#pragma once

#include <span>
#include <vector>

#include "proto/messages/room_commands.h"
#include "server/translate/translate_forces.h"

namespace weft::server {

/// What an `advance` observes of its last tick; empty what it did not ask for.
struct Observation {
  std::span<const float> velocities;  ///< the world's; three per vertex [m/s]
  std::vector<proto::ContactSample> contacts;
  std::vector<proto::ReactionSample> reactions;
  std::vector<proto::GripperSample> grippers;
};

/// Whether contacts and reactions have to be measured for it.
bool observes_forces(const std::vector<proto::Observed>& observe);

/// Contacts and reactions are there if the world measured them in its last tick.
Observation observation_of(const ServedWorld& world, const std::vector<proto::Observed>& observe);

/// Adds it to a frame, which refers to it from then on.
void show(const Observation& observation, proto::FrameView& frame);

}  // namespace weft::server
