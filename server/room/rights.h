#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proto/messages/commands.h"

// What a viewer may do in a room: by its role, and to hold the cloth by the room's policy.

namespace weft::server {

/// Whether a viewer may hold the cloth.
enum class HandRight : std::uint8_t {
  by_policy,
  given,    ///< by an operator or a link, whatever the policy
  waiting,  ///< it came to a crowded room, and looks until it is given a hand
  muted,    ///< by an operator, whatever the policy
};

/// What a viewer is let in with.
struct Grant {
  proto::Role role = proto::Role::operator_;
  HandRight hand = HandRight::by_policy;
  std::string name;         ///< of the person that has the token; may be empty
  bool by_token = false;    ///< otherwise as everyone without a token
  std::string room = {};    ///< where it counts; empty: in all rooms
  std::uint64_t token = 0;  ///< number of the token, which tells nothing of it; 0: none
  std::string maker = {};   ///< whom rooms made by it count for; empty: each viewer for itself
  bool operator==(const Grant&) const = default;
};

/// What a grant is worth in a room. One that counts in another room lets its viewer look, and hold
/// by the policy if it grants a hand there.
Grant grant_in(Grant grant, std::string_view room);

/// Whether a viewer may hold the cloth under a policy.
/// @param leads  an operator by its token, which no policy keeps from holding
bool may_hold(HandRight hand, proto::Policy policy, bool leads);

/// Most hands that a viewer may have.
/// @param usual  of the server
std::uint32_t most_hands(proto::Policy policy, std::uint32_t usual);

/// Why a viewer may not send a command; nothing if it may.
/// @param holds  whether it may hold the cloth
std::optional<proto::Error> check_right(const proto::Command& command, proto::Role role,
                                        bool holds);

}  // namespace weft::server
