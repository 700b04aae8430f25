#pragma once

#include <vector>

#include "core/world/crossing_counter.h"
#include "proto/events.h"
#include "server/translate.h"

// Whether nothing crosses, as counted and as promised, as the wire tells it.

namespace weft::server {

using ServedCrossings = CrossingCounter<float>;

/// Counts in the present state.
/// @param counter   of this world
/// @param meetings  gets who crosses whom
proto::Crossings crossings_of(const ServedWorld& world, ServedCrossings& counter,
                              std::vector<Meeting>& meetings);

/// Objects that were forced through the cloth since the start.
std::vector<std::string> voiding_colliders(const ServedWorld& world);

/// @param bad_starts  that hold now
proto::Guarantee guarantee_of(const ServedWorld& world, const BadStarts& bad_starts);

}  // namespace weft::server
