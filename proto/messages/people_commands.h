#pragma once

#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/field.h"
#include "proto/limits.h"
#include "proto/messages/right.h"
#include "proto/messages/room_commands.h"
#include "proto/types.h"

// Commands about the people in a room: who may hold the cloth, and where each points and looks.

namespace weft::proto {

/// Hands that the new policy does not allow let go.
struct SetPolicy {
  Policy policy = Policy::everybody;
  bool operator==(const SetPolicy&) const = default;

  static constexpr const char* kOp = "policy";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& set) {
    io.required(Field{"policy", "who may hold the cloth"}, set.policy);
  }
};

/// Takes the right to hold from a viewer, whatever the policy.
struct Mute {
  ViewerId viewer = 0;
  bool muted = true;
  bool operator==(const Mute&) const = default;

  static constexpr const char* kOp = "mute";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& mute) {
    io.required(Field{"viewer", "whose hands let go", kIdRange}, mute.viewer);
    io.flag(Field{"muted", "`false`: the policy holds for it again"}, mute.muted, true);
  }
};

/// Gives a viewer the right to hold, whatever the policy.
struct GiveHand {
  ViewerId viewer = 0;
  bool given = true;
  bool operator==(const GiveHand&) const = default;

  static constexpr const char* kOp = "give_hand";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& give) {
    io.required(Field{"viewer", "that may hold", kIdRange}, give.viewer);
    io.flag(Field{"given", "`false`: the policy holds for it again"}, give.given, true);
  }
};

/// Where its viewer points and looks, for others to see; no part of the log.
struct Presence {
  std::optional<Vec3> cursor;
  bool away = false;
  std::optional<Camera> camera;
  bool operator==(const Presence&) const = default;

  static constexpr const char* kOp = "presence";
  static constexpr Right kRight = Right::look;
  static void describe(auto& io, auto& presence) {
    io.optional(Field{"cursor", "what it points at", kPositionRange, "m"}, presence.cursor);
    io.flag(Field{"away", "it points at nothing any more"}, presence.away, false);
    io.optional(Field{"camera", "where it looks from"}, presence.camera);
    io.rule(!presence.cursor || !presence.away, ErrorCode::conflicting_fields, "away",
            "away cannot be combined with cursor");
  }
};

/// Sees by the camera of another viewer from now on.
struct Follow {
  ViewerId viewer = 0;
  bool operator==(const Follow&) const = default;

  static constexpr const char* kOp = "follow";
  static constexpr Right kRight = Right::look;
  static void describe(auto& io, auto& follow) {
    io.required(Field{"viewer", "by whose camera it sees; 0: its own again", kIdRange},
                follow.viewer);
  }
};

/// Brings all viewers to its sender's camera.
struct Lead {
  bool on = true;
  bool operator==(const Lead&) const = default;

  static constexpr const char* kOp = "lead";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& lead) {
    io.flag(Field{"on", "`false`: those that follow its sender see by their own again"}, lead.on,
            true);
  }
};

/// What a link that is handed out lets its viewers do.
enum class Invitation : std::uint8_t { look, hold, operate };
template <>
inline constexpr std::array<const char*, 3> kWords<Invitation> = {"look", "hold", "operate"};

/// Makes a token for a link, which counts until the server stops.
struct Invite {
  Invitation right = Invitation::look;
  bool operator==(const Invite&) const = default;

  static constexpr const char* kOp = "invite";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& invite) {
    io.required(Field{"right", "of who comes by it"}, invite.right);
  }
};

}  // namespace weft::proto
