#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"
#include "proto/field.h"
#include "proto/limits.h"
#include "proto/messages/right.h"
#include "proto/types.h"

// Commands about a viewer, the room's clock and its scene.

namespace weft::proto {

struct Hello {
  std::optional<std::string> name, color, token;
  bool operator==(const Hello&) const = default;

  static constexpr const char* kOp = "hello";
  static constexpr Right kRight = Right::look;
  static void describe(auto& io, auto& hello) {
    io.optional(Field{"name",
                      "without control characters",
                      {1, kMostNameCharacters},
                      "characters",
                      Form::characters},
                hello.name);
    io.optional(Field{"color", "as `#rrggbb`", {}, "", Form::color}, hello.color);
    io.optional(
        Field{"token", "of a link; tells the role", {0, kMostTokenBytes}, "bytes", Form::secret},
        hello.token);
  }
};

struct Camera {
  Vec3 position{}, target{};
  Vec3 up = {0, 1, 0};
  double fov = 45;
  bool operator==(const Camera&) const = default;

  static constexpr const char* kOp = "camera";
  static constexpr Right kRight = Right::look;
  static constexpr const char* kName = "Camera";
  static void describe(auto& io, auto& camera) {
    io.required(Field{"position", "of the eye", kPositionRange, "m"}, camera.position);
    io.required(Field{"target", "what it looks at; not the same point", kPositionRange, "m"},
                camera.target);
    io.optional(Field{"up", "a direction", kPositionRange, "", Form::direction}, camera.up);
    io.optional(Field{"fov", "vertical angle of view", kFovRange, "degrees"}, camera.fov);
    io.rule(camera.position != camera.target, ErrorCode::out_of_range, "target",
            "target must not be the camera's position");
  }
};

struct Pause {
  bool operator==(const Pause&) const = default;
  static constexpr const char* kOp = "pause";
  static constexpr Right kRight = Right::operate;
  static void describe(auto&, auto&) {}
};

struct Resume {
  bool operator==(const Resume&) const = default;
  static constexpr const char* kOp = "resume";
  static constexpr Right kRight = Right::operate;
  static void describe(auto&, auto&) {}
};

struct Step {
  std::uint32_t n = 1;
  bool operator==(const Step&) const = default;

  static constexpr const char* kOp = "step";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& step) {
    io.optional(Field{"n", "ticks", kStepRange}, step.n);
  }
};

struct Reset {
  bool operator==(const Reset&) const = default;
  static constexpr const char* kOp = "reset";
  static constexpr Right kRight = Right::operate;
  static void describe(auto&, auto&) {}
};

inline constexpr Field kSaveName{"name",
                                 "lower-case letters, digits and hyphens",
                                 {1, static_cast<double>(kMostRoomNameBytes)},
                                 "characters",
                                 Form::room_name};

/// Keeps the present state in memory, in place of an earlier one of this name.
struct Save {
  std::string name;
  bool operator==(const Save&) const = default;

  static constexpr const char* kOp = "save";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& save) { io.required(kSaveName, save.name); }
};

struct Restore {
  std::string name;
  bool operator==(const Restore&) const = default;

  static constexpr const char* kOp = "restore";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& restore) { io.required(kSaveName, restore.name); }
};

struct Speed {
  double speed = 1;
  bool operator==(const Speed&) const = default;

  static constexpr const char* kOp = "speed";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& speed) {
    io.required(Field{"speed", "simulated per real time", kSpeedRange}, speed.speed);
  }
};

/// The frames of an `advance` that its viewer gets, regardless of its `hz`.
enum class AdvanceFrames : std::uint8_t { none, last, all };
template <>
inline constexpr std::array<const char*, 3> kWords<AdvanceFrames> = {"none", "last", "all"};

/// What the frame of an `advance`'s last tick tells beside positions.
enum class Observed : std::uint8_t { positions, velocities, contacts, reactions, grippers };
template <>
inline constexpr std::array<const char*, 5> kWords<Observed> = {
    "positions", "velocities", "contacts", "reactions", "grippers"};

struct Advance {
  std::uint32_t n = 1;
  std::optional<AdvanceFrames> frames;
  std::optional<std::vector<Observed>> observe;
  bool operator==(const Advance&) const = default;

  /// Whether it says itself which of its frames its viewer gets.
  bool chooses_frames() const { return frames || observe; }

  static constexpr const char* kOp = "advance";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& advance) {
    io.required(Field{"n", "ticks", kAdvanceRange}, advance.n);
    io.optional(Field{"frames",
                      "its frames that its viewer gets, whatever its `hz`; by default "
                      "those that its `hz` allows"},
                advance.frames);
    io.optional(Field{"observe",
                      "what the frame of its last tick has, beside positions; then `frames` is at "
                      "least `last`",
                      {0, kWords<Observed>.size()}},
                advance.observe);
  }
};

struct Hash {
  bool operator==(const Hash&) const = default;
  static constexpr const char* kOp = "hash";
  static constexpr Right kRight = Right::look;
  static void describe(auto&, auto&) {}
};

struct Ping {
  double t = 0;
  bool operator==(const Ping&) const = default;

  static constexpr const char* kOp = "ping";
  static constexpr Right kRight = Right::look;
  static void describe(auto& io, auto& ping) {
    io.required(Field{"t", "the client's time", {-1e300, 1e300}}, ping.t);
  }
};

struct Load {
  std::string scene;
  std::string definition;  ///< JSON text of a scene instead, not checked yet; empty: use the name
  bool operator==(const Load&) const = default;

  static constexpr const char* kOp = "load";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& load) {
    io.scene(Field{"scene",
                   "its name, or a scene that follows `/api/v1/scene-schema`",
                   {1, kMostSceneBytes},
                   "characters",
                   Form::file_name},
             load.scene, load.definition);
  }
};

enum class Codec : std::uint8_t { f32, packed };
template <>
inline constexpr std::array<const char*, 2> kWords<Codec> = {"f32", "packed"};

struct View {
  std::optional<double> hz;
  std::optional<Codec> codec;
  std::optional<double> error;
  std::optional<bool> forces;
  bool operator==(const View&) const = default;

  static constexpr const char* kOp = "view";
  static constexpr Right kRight = Right::look;
  static constexpr FurtherRight kFurther{"`forces`", Right::operate};
  /// Forces are measured in each tick as soon as one viewer wants them.
  constexpr Right right() const { return forces.value_or(false) ? kFurther.right : kRight; }
  static void describe(auto& io, auto& view) {
    io.optional(Field{"hz", "most frames a second; 0: none", kFrameRateRange}, view.hz);
    io.optional(Field{"codec", "of the positions in frames"}, view.codec);
    io.optional(Field{"error", "most that a packed vertex may be off", kPackedErrorRange, "m"},
                view.error);
    io.optional(Field{"forces", "contacts and reactions in the frames"}, view.forces);
    io.rule(view != View{}, ErrorCode::missing_field, "hz",
            "view needs hz, codec, error or forces");
  }
};

/// The room took back the running tick. Occurs only in logs: no client can send it.
struct Halt {
  std::string cause;  ///< for people to read
  bool operator==(const Halt&) const = default;

  static constexpr const char* kOp = "halt";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& halt) { io.required(Field{"cause", ""}, halt.cause); }
};

}  // namespace weft::proto
