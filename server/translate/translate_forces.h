#pragma once

#include <vector>

#include "core/world/reactions.h"
#include "proto/frames/frame.h"
#include "proto/messages/replies.h"
#include "server/translate/translate.h"

// Contacts and forces of the cloth, in types of the wire.

namespace weft::server {

std::vector<proto::ContactInfo> contacts_of(const ServedWorld& world, const Reactions& reactions);

/// Without hands, because only the room knows their owners.
proto::ReactionInfo reactions_of(const ServedWorld& world, const Reactions& reactions);

/// As measured in the world's last tick.
std::vector<proto::ContactSample> contact_samples(const ServedWorld& world);
std::vector<proto::ReactionSample> reaction_samples(const ServedWorld& world);

}  // namespace weft::server
