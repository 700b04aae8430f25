#pragma once

#include <string>
#include <vector>

#include "proto/messages/events.h"
#include "proto/messages/replies.h"

// One message at least of each kind that the server writes, with the values of the specification's
// examples.

namespace weft::test {

inline const proto::Camera kCamera{{0, 1.2, 3}, {0, 1, 0}, {0, 1, 0}, 45};

proto::State sample_state();
proto::ReactionInfo sample_reactions();
proto::EnergyBalance sample_balance();
std::vector<std::string> sample_events();
std::vector<std::string> sample_replies();
std::vector<std::string> sample_http_bodies();

}  // namespace weft::test
