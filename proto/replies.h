#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "proto/commands.h"
#include "proto/error.h"
#include "proto/events.h"
#include "proto/types.h"

// Answers to commands that carry an id. `tick` is the command's place in the order.

namespace weft::proto {

/// Of a command without further results: camera, reset, set.
struct DoneReply {
  const char* command = "";
  std::uint64_t tick = 0;
};

struct HelloReply {
  ViewerId viewer = 0;
  std::string name, color, role;
};

struct ClothHit {
  SurfacePoint point;
  Vec3 position{};
  std::uint32_t particle = 0;
  double distance = 0;  ///< [m]
};

struct PickReply {
  std::uint64_t tick = 0;
  std::optional<ClothHit> hit;
};

struct DragReply {
  std::uint64_t tick = 0;
  std::uint32_t drag = 0;       ///< the viewer's number
  std::uint32_t grab = 0;       ///< the room's
  std::optional<Vec3> target;   ///< [m]; of a start
  std::optional<Vec3> impulse;  ///< [N s]; of a sling that was fired
};

struct PinReply {
  std::uint64_t tick = 0;
  std::uint32_t pin = 0, particle = 0, count = 0;
};

struct ReleaseReply {
  std::uint64_t tick = 0;
  std::vector<std::uint32_t> released;
};

/// Of pause and of resume.
struct PauseReply {
  std::uint64_t tick = 0;
  bool paused = false;
};

struct StepReply {
  std::uint64_t tick = 0, until = 0;
};

struct SpeedReply {
  std::uint64_t tick = 0;
  double speed = 1;
};

struct MoveReply {
  std::uint64_t tick = 0;
  ColliderRef collider;  ///< as in the command
};

struct MovePinReply {
  std::uint64_t tick = 0;
  std::uint32_t pin = 0;
  Vec3 position{};  ///< of its middle particle, now [m]
};

struct GripperReply {
  std::uint64_t tick = 0;
  std::string gripper;
};

struct AdvanceReply {
  std::uint64_t tick = 0, hash = 0;
};

struct HashReply {
  std::uint64_t tick = 0, hash = 0;
};

struct PingReply {
  double t = 0;         ///< as sent
  double received = 0;  ///< server's clock [s]
  double sent = 0;      ///< server's clock [s]
};

struct LoadReply {
  std::uint64_t tick = 0;
  std::string scene;
  std::uint32_t epoch = 0;
};

struct ViewReply {
  double hz = 0;
  Codec codec = Codec::f32;
  bool forces = false;
  double error = 0;  ///< bound of packed frames [m]
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
};

/// A hierarchy of boxes.
struct TreeInfo {
  std::string tree;
  std::uint32_t levels = 0;
};

/// The present pose of a collider.
struct ColliderPose {
  std::string name;
  Vec3 position{};       ///< of the pivot [m]
  Quat rotation{};       ///< relative to the mesh message
  Vec3 force{};          ///< of the cloth on it while it moves, mean of the last tick [N]
  bool blocked = false;  ///< held back in the last tick by cloth that cannot yield
  bool voided = false;   ///< has moved on through cloth since the start
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
};

struct PinForce {
  std::uint32_t pin = 0;
  Vec3 force{};  ///< of the pin on the cloth [N]
};

struct GrabForce {
  std::uint32_t grab = 0;
  ViewerId viewer = 0;
  Vec3 force{};  ///< of the hand on the cloth [N]
};

struct ColliderForce {
  std::string collider;
  Vec3 force{};  ///< of the cloth on it [N]
};

/// Forces between the cloth and its supports.
struct ReactionInfo {
  std::optional<std::vector<PinForce>> pins;  ///< absent if the solver does not know them
  std::vector<GrabForce> grabs;
  std::vector<ColliderForce> colliders;
};

/// The present state of a gripper.
struct GripperInfo {
  std::string name;
  Vec3 position{};        ///< of its middle [m]
  Quat rotation{};        ///< relative to its definition
  double opening = 0;     ///< between its jaws [m]
  double force = 0;       ///< most that each jaw presses with [N]
  bool gripping = false;  ///< the jaws are stopped by the cloth between them, and press it
  Vec3 reaction{};        ///< of the cloth on both jaws together, mean of the last tick [N]
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
               std::vector<ContactInfo>, ReactionInfo, std::vector<GripperInfo>, Crossings>
      data;
};

using Reply =
    std::variant<DoneReply, HelloReply, PickReply, DragReply, PinReply, ReleaseReply, PauseReply,
                 StepReply, SpeedReply, MoveReply, MovePinReply, GripperReply, AdvanceReply,
                 HashReply, PingReply, LoadReply, ViewReply, VectorsReply, BinaryReply, QueryReply>;

/// The `result` for a command with this id.
std::string encode_reply(const Id& id, const Reply& reply);

/// The `error` message.
std::string encode_error(const Error& error);

}  // namespace weft::proto
