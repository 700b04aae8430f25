#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proto/error.h"
#include "proto/limits.h"
#include "proto/types.h"

// The commands of a client. README.md section 5 gives their meanings; ranges are in limits.h.

namespace weft::proto {

struct Hello {
  std::optional<std::string> name;   ///< 1 to 32 characters without control characters
  std::optional<std::string> color;  ///< "#rrggbb"
  std::optional<std::string> token;
  bool operator==(const Hello&) const = default;
};

/// A ray [m]; `direction` has a component of at least kLeastDirection and need not be of unit
/// length.
struct Pick {
  Vec3 origin{}, direction{};
  bool operator==(const Pick&) const = default;
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

enum class DragMode : std::uint8_t { live, sling };

inline constexpr double kLiveStiffness = 150;  ///< by default [N/m]
inline constexpr double kSlingStiffness = 20;  ///< by default [N/m]

struct DragStart {
  std::uint32_t drag = 0;  ///< the viewer's own number for it
  Hold hold;
  std::optional<Vec3> target;         ///< [m]; absent: the present position of the held point
  double radius = 0.03;               ///< of the held disc in the fabric [m]
  double stiffness = kLiveStiffness;  ///< [N/m]
  double max_force = 50;              ///< [N]
  DragMode mode = DragMode::live;
  bool operator==(const DragStart&) const = default;
};

struct DragMove {
  std::uint32_t drag = 0;
  Vec3 target{};  ///< [m]
  bool operator==(const DragMove&) const = default;
};

struct DragEnd {
  std::uint32_t drag = 0;
  bool fire = true;  ///< of a sling: give the impulse
  bool operator==(const DragEnd&) const = default;
};

struct Pin {
  Hold hold;
  double radius = 0;  ///< of the fixed disc in the fabric [m]; 0: only the particle
  bool operator==(const Pin&) const = default;
};

struct ReleasePin {
  std::uint32_t pin = 0;
  bool operator==(const ReleasePin&) const = default;
};

struct ReleaseParticle {
  std::uint32_t particle = 0;
  bool operator==(const ReleaseParticle&) const = default;
};

struct ReleaseAll {
  bool operator==(const ReleaseAll&) const = default;
};

struct Camera {
  Vec3 position{}, target{};  ///< [m], not the same point
  Vec3 up = {0, 1, 0};        ///< a direction
  double fov = 45;            ///< vertical angle of view [degrees]
  bool operator==(const Camera&) const = default;
};

struct Pause {
  bool operator==(const Pause&) const = default;
};

struct Resume {
  bool operator==(const Resume&) const = default;
};

struct Step {
  std::uint32_t n = 1;  ///< ticks
  bool operator==(const Step&) const = default;
};

struct Reset {
  bool operator==(const Reset&) const = default;
};

struct Speed {
  double speed = 1;  ///< simulated per real time
  bool operator==(const Speed&) const = default;
};

/// A local wind; README.md section 5 defines its numbers.
struct Fan {
  Vec3 position{};       ///< [m]
  Vec3 direction{};      ///< with a component of at least kLeastDirection
  double speed = 5;      ///< [m/s]
  double radius = 0.25;  ///< [m]
  double spread = 0.2;   ///< a slope
  double reach = 1.5;    ///< [m]
  bool operator==(const Fan&) const = default;
};

/// Sends a collider to a pose; omitted values stay as they are.
struct Move {
  ColliderRef collider;
  std::optional<Vec3> position;  ///< target of its pivot [m]
  std::optional<Quat> rotation;  ///< relative to the mesh message
  double speed = 0.5;            ///< at most [m/s]
  double turn_speed = 2;         ///< at most [rad/s]
  bool force = false;            ///< go on even if cloth cannot yield
  bool operator==(const Move&) const = default;
};

/// Returns a collider to its keyframes; one without keyframes stays where it is.
struct MoveEnd {
  ColliderRef collider;
  bool operator==(const MoveEnd&) const = default;
};

/// Sends a pin to a place, no faster than `speed` or, if given, within `seconds`.
struct MovePin {
  std::uint32_t pin = 0;
  Vec3 position{};                ///< target of its middle particle [m]
  double speed = 2;               ///< at most [m/s]
  std::optional<double> seconds;  ///< duration, in place of a speed [s]
  double max_force = 50;          ///< on the cloth during the motion [N]
  bool operator==(const MovePin&) const = default;
};

/// Stops a moving pin and fixes it where it is.
struct StopPin {
  std::uint32_t pin = 0;
  bool operator==(const StopPin&) const = default;
};

/// The room's remedy if ticks exceed their time budget.
enum class OverBudget : std::uint8_t { slow, soften };

/// Commands a gripper; omitted values stay as they are. At least one is set.
struct Gripper {
  std::string gripper;               ///< its name, 1 to 56 bytes
  std::optional<double> opening;     ///< between its jaws [m]; 0 closes on the cloth between
  std::optional<double> force;       ///< of each jaw [N]
  std::optional<Vec3> position;      ///< target of its middle [m]
  std::optional<Quat> rotation;      ///< relative to its definition
  std::optional<double> speed;       ///< at most [m/s]
  std::optional<double> turn_speed;  ///< at most [rad/s]
  bool operator==(const Gripper&) const = default;
};

/// At least one of them is set.
struct Set {
  std::optional<Vec3> gravity;        ///< [m/s^2]
  std::optional<Vec3> wind;           ///< [m/s]
  std::optional<double> gust_speed;   ///< [m/s]
  std::optional<double> gust_length;  ///< [m]
  std::optional<double> air_density;  ///< [kg/m^3]
  std::optional<bool> still_air;
  std::optional<double> drag;            ///< [1/s]
  std::optional<std::vector<Fan>> fans;  ///< all of them, at most kMostFans
  std::optional<double> softness;        ///< fraction of the springs' stiffness
  std::optional<double> budget_ms;       ///< for each due tick [ms]; 0: no bound
  std::optional<OverBudget> over_budget;
  bool operator==(const Set&) const = default;
};

/// The frames of an `advance` that its viewer gets, regardless of its `hz`.
enum class AdvanceFrames : std::uint8_t { none, last, all };

struct Advance {
  std::uint32_t n = 1;                  ///< ticks
  std::optional<AdvanceFrames> frames;  ///< absent: as `view` allows
  bool operator==(const Advance&) const = default;
};

enum class QueryWhat : std::uint8_t {
  positions,
  velocities,
  energies,
  strain,
  pins,
  grabs,
  camera,
  roster,
  state,
  work,
  trees,
  boxes,
  colliders,
  measurements,
  contacts,
  reactions,
  grippers,
  crossings
};
enum class QueryFormat : std::uint8_t { json, f32, f64 };

/// A binary format is only for positions, velocities and boxes, a viewer only for camera, a tree
/// and a level only for boxes, which need a tree.
struct Query {
  QueryWhat what = QueryWhat::positions;
  QueryFormat format = QueryFormat::json;
  std::optional<ViewerId> viewer;
  std::optional<std::string> tree;     ///< 1 to kMostTreeBytes bytes
  std::optional<std::uint32_t> level;  ///< 0, if absent, is the root
  bool operator==(const Query&) const = default;
};

struct Hash {
  bool operator==(const Hash&) const = default;
};

struct Ping {
  double t = 0;  ///< the client's time, any number
  bool operator==(const Ping&) const = default;
};

struct Load {
  std::string scene;       ///< 1 to 64 of a-z A-Z 0-9 . _ -, not beginning with a dot
  std::string definition;  ///< JSON text of a scene instead, not checked yet; empty: use the name
  bool operator==(const Load&) const = default;
};

enum class Codec : std::uint8_t { f32, packed };

struct View {
  std::optional<double> hz;  ///< most frames a second; 0: none
  std::optional<Codec> codec;
  std::optional<double> error;  ///< most that a packed vertex may be off [m]
  std::optional<bool> forces;   ///< contacts and reactions in the frames
  bool operator==(const View&) const = default;
};

/// The room took back the running tick. Occurs only in logs: no client can send it.
struct Halt {
  std::string cause;  ///< for people to read
  bool operator==(const Halt&) const = default;
};

using Command =
    std::variant<Hello, Pick, DragStart, DragMove, DragEnd, Pin, ReleasePin, ReleaseParticle,
                 ReleaseAll, Camera, Pause, Resume, Step, Reset, Speed, Move, MoveEnd, MovePin,
                 StopPin, Gripper, Set, Advance, Query, Hash, Ping, Load, View, Halt>;

/// The word in `op`, e.g. "drag".
const char* name_of(const Command& command);
const char* name_of(DragMode mode);
const char* name_of(QueryWhat what);
const char* name_of(QueryFormat format);
const char* name_of(Codec codec);
const char* name_of(OverBudget remedy);
const char* name_of(AdvanceFrames frames);

/// A command with the id that its sender gave, if any.
struct Request {
  std::optional<Id> id;
  Command command;
  bool operator==(const Request&) const = default;
};

/// Parses one text message. Never throws on its content. An error carries the command's id and name
/// as far as they could be read, and can be encoded as the answer.
Result<Request> parse_request(std::string_view text);

/// Finds the id that `parse_request` would answer with, without parsing the rest, for messages that
/// are refused unread. Takes any bytes, of any length and depth, in one pass and without
/// building a tree. Empty if the text is not an object, does not end with it, or has no id or two.
std::optional<Id> find_id(std::string_view text);

/// The JSON text that parses to the same request; for logs and clients.
std::string encode_request(const Request& request);

}  // namespace weft::proto
