#pragma once

#include <vector>

#include "core/world/crossing_counter.h"
#include "proto/messages/events.h"
#include "server/translate/translate.h"

// Whether nothing crosses, as counted and as promised, in types of the wire.

namespace weft::server {

using ServedCrossings = CrossingCounter<float>;

/// Counts crossings in the present state.
/// @param counter   of this world
/// @param meetings  receives which pairs cross
proto::Crossings crossings_of(const ServedWorld& world, ServedCrossings& counter,
                              std::vector<Meeting>& meetings);

/// Objects that were forced through the cloth since the start.
std::vector<std::string> voiding_colliders(const ServedWorld& world);

/// @param bad_starts  those still in force
proto::Guarantee guarantee_of(const ServedWorld& world, const BadStarts& bad_starts);

}  // namespace weft::server
