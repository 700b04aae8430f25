#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "proto/error.h"
#include "proto/messages/commands.h"
#include "proto/messages/events.h"
#include "proto/messages/people_replies.h"
#include "proto/messages/rooms_replies.h"
#include "proto/types.h"

// Answers to commands that carry an id. `tick` is the command's place in the order.

namespace weft::proto {

/// Of a command without further results: camera, reset, set.
struct DoneReply {
  const char* command = "";
  std::uint64_t tick = 0;
  static void describe(auto& io, auto& reply) { io.required(kReplyTick, reply.tick); }
};

struct ClothHit {
  SurfacePoint point;
  Vec3 position{};
  std::uint32_t particle = 0;
  double distance = 0;  ///< [m]
  static constexpr const char* kName = "Hit";
  static void describe(auto& io, auto& hit) {
    io.required(kHeldTriangle, hit.point.triangle);
    io.required(kHeldWeights, hit.point.barycentric);
    io.required(Field{"position", "of the point", {}, "m"}, hit.position);
    io.required(Field{"particle", "its nearest corner"}, hit.particle);
    io.required(Field{"distance", "along the ray", {}, "m"}, hit.distance);
  }
};

struct PickReply {
  std::uint64_t tick = 0;
  std::optional<ClothHit> hit;
  static constexpr const char* kOp = "pick";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.nullable(Field{"hit", "null: the ray meets no cloth"}, reply.hit);
  }
};

struct DragReply {
  std::uint64_t tick = 0;
  std::uint32_t drag = 0;       ///< the viewer's number
  std::uint32_t grab = 0;       ///< the room's
  std::optional<Vec3> target;   ///< [m]; of a start
  std::optional<Vec3> impulse;  ///< [N s]; of a sling that was fired
  static constexpr const char* kOp = "drag";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"drag", "the viewer's number"}, reply.drag);
    io.required(Field{"grab", "the room's number of the hand"}, reply.grab);
    io.optional(Field{"target", "of a start", {}, "m"}, reply.target);
    io.optional(Field{"impulse", "of a sling that was fired", {}, "N s"}, reply.impulse);
  }
};

struct PinReply {
  std::uint64_t tick = 0;
  std::uint32_t pin = 0, particle = 0, count = 0;
  static constexpr const char* kOp = "pin";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"pin", "its id"}, reply.pin);
    io.required(Field{"particle", "its centre"}, reply.particle);
    io.required(Field{"count", "particles that it holds"}, reply.count);
  }
};

struct ReleaseReply {
  std::uint64_t tick = 0;
  std::vector<std::uint32_t> released;
  static constexpr const char* kOp = "release";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"released", "ids of the pins that are gone"}, reply.released);
  }
};

/// Of pause and of resume.
struct PauseReply {
  std::uint64_t tick = 0;
  bool paused = false;
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"paused", "whether the room is"}, reply.paused);
  }
};

struct StepReply {
  std::uint64_t tick = 0, until = 0;
  static constexpr const char* kOp = "step";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"until", "tick at which the room stands still again"}, reply.until);
  }
};

struct SpeedReply {
  std::uint64_t tick = 0;
  double speed = 1;
  static constexpr const char* kOp = "speed";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"speed", "simulated per real time"}, reply.speed);
  }
};

struct MoveReply {
  std::uint64_t tick = 0;
  ColliderRef collider;  ///< as in the command
  static constexpr const char* kOp = "move";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"collider", "as in the command"}, reply.collider);
  }
};

struct MovePinReply {
  std::uint64_t tick = 0;
  std::uint32_t pin = 0;
  Vec3 position{};  ///< of its middle particle, now [m]
  static constexpr const char* kOp = "move";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"pin", "its id"}, reply.pin);
    io.required(Field{"position", "where it was", {}, "m"}, reply.position);
  }
};

struct GripperReply {
  std::uint64_t tick = 0;
  std::string gripper;
  static constexpr const char* kOp = "gripper";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"gripper", "its name"}, reply.gripper);
  }
};

struct AdvanceReply {
  std::uint64_t tick = 0, hash = 0;
  static constexpr const char* kOp = "advance";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.hash(Field{"hash", "of the state"}, reply.hash);
  }
};

struct HashReply {
  std::uint64_t tick = 0, hash = 0;
  static constexpr const char* kOp = "hash";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.hash(Field{"hash", "of the state"}, reply.hash);
  }
};

struct PingReply {
  double t = 0;         ///< as sent
  double received = 0;  ///< server's clock [s]
  double sent = 0;      ///< server's clock [s]
  static constexpr const char* kOp = "ping";
  static void describe(auto& io, auto& reply) {
    io.required(Field{"t", "as sent"}, reply.t);
    io.required(Field{"received", "by the server's clock", {}, "s"}, reply.received);
    io.required(Field{"sent", "by the server's clock", {}, "s"}, reply.sent);
  }
};

struct LoadReply {
  std::uint64_t tick = 0;
  std::string scene;
  std::uint32_t epoch = 0;
  static constexpr const char* kOp = "load";
  static void describe(auto& io, auto& reply) {
    io.required(kReplyTick, reply.tick);
    io.required(Field{"scene", "its name"}, reply.scene);
    io.required(Field{"epoch", "of its mesh"}, reply.epoch);
  }
};

struct ViewReply {
  double hz = 0;
  Codec codec = Codec::f32;
  bool forces = false;
  double error = 0;  ///< bound of packed frames [m]
  static constexpr const char* kOp = "view";
  static void describe(auto& io, auto& reply) {
    io.required(Field{"hz", "most frames a second"}, reply.hz);
    io.required(Field{"codec", "of the positions in frames"}, reply.codec);
    io.only_if(reply.codec == Codec::packed, "packed",
               Field{"error", "most that a vertex may be off", {}, "m"}, reply.error, true);
    io.required(Field{"forces", "contacts and reactions in the frames"}, reply.forces);
  }
};

/// Positions, velocities or boxes as JSON, `components` values per row. Only encode_reply reads the
/// data.
struct VectorsReply {
  std::uint64_t tick = 0;
  QueryWhat what = QueryWhat::positions;
  std::variant<std::span<const float>, std::span<const double>> values;
  std::size_t components = 3;
};

/// Announces the binary data message (data.h) that follows.
struct BinaryReply {
  std::uint64_t tick = 0;
  QueryWhat what = QueryWhat::positions;
  QueryFormat format = QueryFormat::f32;
  std::uint32_t transfer = 0, count = 0, components = 3;
};

struct ViewerCamera {
  ViewerId viewer = 0;
  Camera camera;
};

struct StageWork {
  std::string stage;
  double milliseconds = 0;
  std::uint64_t work = 0;
  static constexpr const char* kName = "StageWork";
  static void describe(auto& io, auto& work) {
    io.required(Field{"stage", "of the tick"}, work.stage);
    io.required(Field{"milliseconds", "", {}, "ms"}, work.milliseconds);
    io.required(Field{"work", "items done"}, work.work);
  }
};

/// A hierarchy of boxes.
struct TreeInfo {
  std::string tree;
  std::uint32_t levels = 0;
  static constexpr const char* kName = "Tree";
  static void describe(auto& io, auto& tree) {
    io.required(Field{"tree", "its name"}, tree.tree);
    io.required(Field{"levels", "of boxes"}, tree.levels);
  }
};

/// The present pose of a collider.
struct ColliderPose {
  std::string name;
  Vec3 position{};       ///< of the pivot [m]
  Quat rotation{};       ///< relative to the mesh message
  Vec3 force{};          ///< of the cloth on it while it moves, mean of the last tick [N]
  bool blocked = false;  ///< held back in the last tick by cloth that cannot yield
  bool voided = false;   ///< has moved on through cloth since the start
  static constexpr const char* kName = "ColliderPose";
  static void describe(auto& io, auto& pose) {
    io.required(Field{"name", ""}, pose.name);
    io.required(Field{"position", "of the pivot", {}, "m"}, pose.position);
    io.required(Field{"rotation", "relative to the mesh message"}, pose.rotation);
    io.required(Field{"force", "of the cloth on it while it moves", {}, "N"}, pose.force);
    io.required(Field{"blocked", "held back in the last tick"}, pose.blocked);
    io.required(Field{"voided", "has moved on through cloth"}, pose.voided);
  }
};

/// A contact of the cloth with an object, or with itself.
struct ContactInfo {
  std::optional<std::string> collider;   ///< absent: the other side is cloth too
  std::vector<std::uint32_t> particles;  ///< 1 to 3; 4 of both sides if both are cloth
  std::vector<double> weights;           ///< negative on the other side
  Vec3 point{}, normal{};                ///< on the mid-surface [m]; unit, out of the other side
  double gap = 0;                        ///< from the mid-surface to the other side [m]
  double normal_force = 0;               ///< on the cloth, along the normal [N]
  Vec3 friction{};                       ///< on the cloth, tangential [N]
  static constexpr const char* kName = "Contact";
  static void describe(auto& io, auto& contact) {
    io.optional(Field{"collider", "absent: the other side is cloth too"}, contact.collider);
    io.required(Field{"particles", "of the cloth"}, contact.particles);
    io.required(Field{"weights", "sum 1; negative on the other side"}, contact.weights);
    io.required(Field{"point", "on the mid-surface", {}, "m"}, contact.point);
    io.required(Field{"normal", "unit, out of the other side"}, contact.normal);
    io.required(Field{"gap", "from the mid-surface", {}, "m"}, contact.gap);
    io.required(Field{"normal_force", "on the cloth", {}, "N"}, contact.normal_force);
    io.required(Field{"friction", "on the cloth", {}, "N"}, contact.friction);
  }
};

struct PinForce {
  std::uint32_t pin = 0;
  Vec3 force{};  ///< of the pin on the cloth [N]
  static constexpr const char* kName = "PinForce";
  static void describe(auto& io, auto& pin) {
    io.required(Field{"pin", "its id"}, pin.pin);
    io.required(Field{"force", "on the cloth", {}, "N"}, pin.force);
  }
};

struct GrabForce {
  std::uint32_t grab = 0;
  ViewerId viewer = 0;
  Vec3 force{};  ///< of the hand on the cloth [N]
  static constexpr const char* kName = "GrabForce";
  static void describe(auto& io, auto& grab) {
    io.required(Field{"grab", "its number"}, grab.grab);
    io.required(Field{"viewer", "its owner"}, grab.viewer);
    io.required(Field{"force", "on the cloth", {}, "N"}, grab.force);
  }
};

struct ColliderForce {
  std::string collider;
  Vec3 force{};  ///< of the cloth on it [N]
  static constexpr const char* kName = "ColliderForce";
  static void describe(auto& io, auto& collider) {
    io.required(Field{"collider", "its name"}, collider.collider);
    io.required(Field{"force", "of the cloth on it", {}, "N"}, collider.force);
  }
};

/// Forces between the cloth and its supports.
struct ReactionInfo {
  std::optional<std::vector<PinForce>> pins;  ///< absent if the solver does not know them
  std::vector<GrabForce> grabs;
  std::vector<ColliderForce> colliders;
  static constexpr const char* kName = "Reactions";
  static void describe(auto& io, auto& reactions) {
    io.optional(Field{"pins", "absent if the solver does not know them"}, reactions.pins);
    io.required(Field{"grabs", "of hands"}, reactions.grabs);
    io.required(Field{"colliders", ""}, reactions.colliders);
  }
};

/// The present state of a gripper.
struct GripperInfo {
  std::string name;
  Vec3 position{};                ///< of its middle [m]
  Quat rotation{};                ///< relative to its definition
  double opening = 0, force = 0;  ///< between its jaws [m]; most that each jaw presses with [N]
  bool gripping = false;          ///< the jaws are stopped by the cloth between them, and press it
  Vec3 reaction{}, torque{};      ///< of the cloth on both jaws [N]; about its middle [N m]
  static constexpr const char* kName = "GripperState";
  static void describe(auto& io, auto& gripper) {
    io.required(Field{"name", ""}, gripper.name);
    io.required(Field{"position", "of its middle", {}, "m"}, gripper.position);
    io.required(Field{"rotation", "from its definition"}, gripper.rotation);
    io.required(Field{"opening", "between its jaws", {}, "m"}, gripper.opening);
    io.required(Field{"force", "most that each jaw presses with", {}, "N"}, gripper.force);
    io.required(Field{"gripping", "it presses something"}, gripper.gripping);
    io.required(Field{"reaction", "of the cloth on both jaws", {}, "N"}, gripper.reaction);
    io.required(Field{"torque", "the same about its middle", {}, "N m"}, gripper.torque);
  }
};

/// Measurements of the scene's test, by names that end in their unit; empty for other scenes.
struct Measurements {
  std::vector<std::pair<std::string, double>> values;
};

/// All other queries; the alternative determines `what`.
struct QueryReply {
  std::uint64_t tick = 0;
  std::variant<Energy, Strain, std::vector<PinInfo>, std::vector<GrabInfo>,
               std::vector<ViewerCamera>, std::vector<ViewerInfo>, State, std::vector<StageWork>,
               std::vector<TreeInfo>, std::vector<ColliderPose>, Measurements,
               std::vector<ContactInfo>, ReactionInfo, std::vector<GripperInfo>, Crossings,
               EnergyBalance>
      data;
};

using Reply =
    std::variant<DoneReply, HelloReply, InviteReply, PickReply, DragReply, PinReply, ReleaseReply,
                 PauseReply, StepReply, SpeedReply, MoveReply, MovePinReply, GripperReply,
                 AdvanceReply, HashReply, PingReply, LoadReply, CreateRoomReply, ListRoomsReply,
                 CloseRoomReply, ForkReply, ViewReply, VectorsReply, BinaryReply, QueryReply>;

/// The `result` for a command with this id.
std::string encode_reply(const Id& id, const Reply& reply);

/// The `error` message.
std::string encode_error(const Error& error);

}  // namespace weft::proto
