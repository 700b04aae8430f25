#pragma once

#include <vector>

#include "core/world/crossing_counter.h"
#include "proto/messages/events.h"
#include "server/translate/translate.h"

// Whether nothing crosses, as counted and as promised, in types of the wire.

namespace weft::server {

/// Counts crossings in the present state.
/// @param counter   of this world
/// @param meetings  receives which pairs cross
template <class Real>
proto::Crossings crossings_of(const World<Real>& world, CrossingCounter<Real>& counter,
                              std::vector<Meeting>& meetings);

/// Objects that were forced through the cloth since the start.
template <class Real>
std::vector<std::string> voiding_colliders(const World<Real>& world);

/// @param bad_starts  those still in force
template <class Real>
proto::Guarantee guarantee_of(const World<Real>& world, const BadStarts& bad_starts);

}  // namespace weft::server
