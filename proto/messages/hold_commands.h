#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "proto/field.h"
#include "proto/limits.h"
#include "proto/messages/right.h"
#include "proto/types.h"

// Commands that point at the cloth, pull it and pin it.

namespace weft::proto {

/// First triangle that a ray meets.
struct Pick {
  Vec3 origin{}, direction{};
  bool operator==(const Pick&) const = default;

  static constexpr const char* kOp = "pick";
  static constexpr Right kRight = Right::look;
  static void describe(auto& io, auto& pick) {
    io.required(Field{"origin", "where the ray starts", kPositionRange, "m"}, pick.origin);
    io.required(Field{"direction", "of any length but 0: its largest component is at least 1e-9",
                      kPositionRange, "", Form::direction},
                pick.direction);
  }
};

struct Particle {
  std::uint32_t index = 0;
  bool operator==(const Particle&) const = default;
};

/// A point of a triangle; the weights are in 0 to 1 with sum 1 within kWeightSumTolerance.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  Vec3 barycentric{};
  bool operator==(const SurfacePoint&) const = default;
};

/// Where to hold the cloth. The receiver checks that the index exists.
using Hold = std::variant<Particle, SurfacePoint>;
inline constexpr Field kHeldParticle{"particle", "to hold it at a particle", kIndexRange};
inline constexpr Field kHeldTriangle{"triangle", "to hold it at a point of this triangle",
                                     kIndexRange};
inline constexpr Field kHeldWeights{"barycentric", "of that point; sum 1 within 0.001",
                                    kWeightRange, "", Form::weights};

enum class DragPhase : std::uint8_t { start, move, end };
template <>
inline constexpr std::array<const char*, 3> kWords<DragPhase> = {"start", "move", "end"};

enum class DragMode : std::uint8_t { live, sling };
template <>
inline constexpr std::array<const char*, 2> kWords<DragMode> = {"live", "sling"};

inline constexpr double kLiveStiffness = 150;  ///< by default [N/m]
inline constexpr double kSlingStiffness = 20;  ///< by default [N/m]
inline constexpr Field kDragNumber{"drag", "the viewer's own number for it", kIndexRange};

struct DragStart {
  std::uint32_t drag = 0;
  Hold hold;
  std::optional<Vec3> target;
  double radius = 0.03;
  double stiffness = kLiveStiffness;
  double max_force = 50;
  DragMode mode = DragMode::live;
  bool operator==(const DragStart&) const = default;

  static constexpr const char* kOp = "drag";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& start) {
    io.constant("phase", "start");
    io.optional(kDragNumber, start.drag);
    io.hold(start.hold);
    io.optional(Field{"mode", "`sling` leaves the cloth alone until `end`"}, start.mode);
    io.usual(start.stiffness, start.mode == DragMode::sling ? kSlingStiffness : kLiveStiffness);
    io.optional(Field{"target", "where it is pulled to; by default where that point is now",
                      kPositionRange, "m"},
                start.target);
    io.optional(Field{"radius", "of the held disc in the fabric", kRadiusRange, "m"}, start.radius);
    io.optional(Field{"stiffness", "of the hand; of a sling by default 20", kStiffnessRange, "N/m"},
                start.stiffness);
    io.optional(Field{"max_force", "beyond which the cloth lags", kForceRange, "N"},
                start.max_force);
  }
};

struct DragMove {
  std::uint32_t drag = 0;
  Vec3 target{};
  bool operator==(const DragMove&) const = default;

  static constexpr const char* kOp = "drag";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& move) {
    io.constant("phase", "move");
    io.optional(kDragNumber, move.drag);
    io.required(Field{"target", "where it is pulled to", kPositionRange, "m"}, move.target);
  }
};

struct DragEnd {
  std::uint32_t drag = 0;
  bool fire = true;
  bool operator==(const DragEnd&) const = default;

  static constexpr const char* kOp = "drag";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& end) {
    io.constant("phase", "end");
    io.optional(kDragNumber, end.drag);
    io.flag(Field{"fire", "of a sling: give the impulse"}, end.fire, true);
  }
};

struct Pin {
  Hold hold;
  double radius = 0;
  bool operator==(const Pin&) const = default;

  static constexpr const char* kOp = "pin";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& pin) {
    io.hold(pin.hold);
    io.optional(Field{"radius", "of the fixed disc in the fabric; 0: the particle alone",
                      kRadiusRange, "m"},
                pin.radius);
  }
};

struct ReleasePin {
  std::uint32_t pin = 0;
  bool operator==(const ReleasePin&) const = default;

  static constexpr const char* kOp = "release";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& release) {
    io.required(Field{"pin", "id of the pin", kIdRange}, release.pin);
  }
};

struct ReleaseParticle {
  std::uint32_t particle = 0;
  bool operator==(const ReleaseParticle&) const = default;

  static constexpr const char* kOp = "release";
  static constexpr Right kRight = Right::hold;
  static void describe(auto& io, auto& release) {
    io.required(Field{"particle", "all pins that hold it; none is no error", kIndexRange},
                release.particle);
  }
};

struct ReleaseAll {
  bool operator==(const ReleaseAll&) const = default;

  static constexpr const char* kOp = "release";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto&) { io.constant("all", true); }
};

}  // namespace weft::proto
