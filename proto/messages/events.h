#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "proto/hash_text.h"
#include "proto/messages/commands.h"
#include "proto/messages/energy.h"
#include "proto/types.h"

// Messages that the server sends unasked. README.md section 4 gives the meaning of each field.

namespace weft::proto {

/// Limits in force at this server.
struct ServerLimits {
  std::size_t message_bytes = kMostMessageBytes;
  double messages_per_second = 1000;
  std::uint32_t viewers = 1000;
  std::uint32_t drags_per_viewer = 16;
  std::uint32_t drags = 256;
  std::uint32_t pins = 4096;
  double lease_seconds = 2;
  std::uint32_t frames_in_flight = 12;
};

struct Welcome {
  std::string version;
  std::string session;  ///< new for each process
  ViewerId viewer = 0;
  std::string name, color;
  Role role = Role::viewer;
  std::string room = "default";
  std::string scene;
  double tick_rate = 60;  ///< [1/s]
  double clock = 0;       ///< server's monotonic clock, now [s]
  std::vector<std::string> codecs = {"f32", "packed"};
  ServerLimits limits;
  std::vector<std::string> capabilities;
};

/// How a cloth is meant to look; each is empty if the scene does not tell it.
struct LookInfo {
  std::string fabric;       ///< such as "silk"
  std::string color, back;  ///< "#rrggbb", of the front and of the back
};

struct ClothInfo {
  std::string name;
  std::uint32_t first_vertex = 0, vertices = 0;
  std::uint32_t first_triangle = 0, triangles = 0;
  std::uint32_t rows = 0, columns = 0;  ///< of a grid; 0 for other cloths
  double thickness = 0;                 ///< [m]
  LookInfo look;
};

/// Where a scene is best looked at from.
struct ViewInfo {
  Vec3 target{};      ///< [m]
  Vec3 direction{};   ///< from the target towards the eye, unit length
  double radius = 0;  ///< of the sphere about the target that fills the picture [m]
};

struct PlaneInfo {
  Vec3 point{}, normal{};  ///< unit normal, away from the solid
};
struct SphereInfo {
  Vec3 center{};
  double radius = 0;
};
struct CapsuleInfo {
  Vec3 a{}, b{};
  double radius = 0;
};
struct BoxInfo {
  Vec3 center{}, half_extents{};
  std::array<double, 4> orientation = {0, 0, 0, 1};  ///< unit quaternion x y z w
};
struct MeshInfo {
  std::uint32_t vertices = 0, triangles = 0;  ///< the data is in the binary mesh message
};

struct ColliderInfo {
  std::string name;
  std::variant<PlaneInfo, SphereInfo, CapsuleInfo, BoxInfo, MeshInfo> shape;
  Vec3 pivot{};  ///< reference point of a pose [m]
};

/// The text message `mesh`; SceneMesh of mesh.h is the binary one that follows it.
struct MeshAnnouncement {
  std::uint32_t epoch = 0;
  std::string scene;
  std::uint64_t hash = 0;  ///< of the binary message, content_hash()
  std::size_t bytes = 0;   ///< of the binary message
  std::uint32_t vertices = 0, triangles = 0;
  std::vector<ClothInfo> cloths;
  std::vector<ColliderInfo> colliders;
  std::optional<ViewInfo> view;
};

struct Strain {
  double largest = 0, p99 = 0;

  static constexpr const char* kName = "Strain";
  static void describe(auto& io, auto& strain) {
    io.required(Field{"largest", "of an edge, relative"}, strain.largest);
    io.required(Field{"p99", "which one edge in a hundred exceeds"}, strain.p99);
  }
};

/// Cloths at rest, which are not stepped until something acts on them.
struct Sleeping {
  std::uint32_t islands = 0;  ///< groups of touching cloths that sleep and wake together
  std::vector<std::string> cloths;

  static constexpr const char* kName = "Sleeping";
  static void describe(auto& io, auto& sleeping) {
    io.required(Field{"islands", "groups of touching cloths that sleep and wake together"},
                sleeping.islands);
    io.required(Field{"cloths", "by name; no frames are sent while all of them rest"},
                sleeping.cloths);
  }
};

/// Intersections of cloths' edges and triangles, with each other and with objects.
struct Crossings {
  std::uint64_t count = 0;
  std::uint64_t tick = 0;              ///< of the state in which they were counted
  std::optional<double> smallest_gap;  ///< least contact distance then [m]; empty: nothing is near

  static constexpr const char* kName = "Crossings";
  static void describe(auto& io, auto& crossings) {
    io.required(Field{"count", "edges of cloth that pass through something"}, crossings.count);
    io.required(Field{"tick", "of the count"}, crossings.tick);
    io.nullable(Field{"smallest_gap",
                      "least contact distance then, negative inside an object; null: nothing is "
                      "near",
                      {},
                      "m"},
                crossings.smallest_gap);
  }
};

/// Whether the promise of no crossings holds.
enum class GuaranteeState : std::uint8_t {
  held,
  bad_start,  ///< except for features that were crossed at the start
  broken,     ///< an object was forced through the cloth; `void` on the wire
  none,       ///< the contact promises nothing
};

template <>
inline constexpr std::array<const char*, 4> kWords<GuaranteeState> = {"held", "bad_start", "void",
                                                                      "none"};

struct Guarantee {
  GuaranteeState state = GuaranteeState::held;
  std::vector<std::string> covers;   ///< the words "objects" and "cloth", as far as it covers them
  std::uint64_t pairs = 0;           ///< number of feature pairs without a promise
  std::vector<std::string> reasons;  ///< in words; none if it is held

  static constexpr const char* kName = "Guarantee";
  static void describe(auto& io, auto& guarantee) {
    io.required(Field{"state", "whether the promise of no crossings holds"}, guarantee.state);
    io.required(Field{"covers", "`objects`, `cloth` or both"}, guarantee.covers);
    io.required(Field{"pairs", "of features, without a promise"}, guarantee.pairs);
    io.required(Field{"reasons", "in words; none if the promise holds"}, guarantee.reasons);
  }
};

/// What moves and resists the cloth everywhere; its fields are `state`'s own on the wire.
struct Air {
  Vec3 wind{};
  double gust_speed = 0, gust_length = 0, density = 0;
  bool still = false;
  double drag = 0;
  std::vector<Fan> fans;

  static void describe(auto& io, auto& air) {
    io.required(Field{"wind", "mean velocity", {}, "m/s"}, air.wind);
    io.required(Field{"gust_speed", "bound of each component of the gusts", {}, "m/s"},
                air.gust_speed);
    io.required(Field{"gust_length", "size of an eddy", {}, "m"}, air.gust_length);
    io.required(Field{"air_density", "", {}, "kg/m³"}, air.density);
    io.required(Field{"still_air", "air resists without wind too"}, air.still);
    io.required(Field{"drag", "uniform damping of velocities", {}, "1/s"}, air.drag);
    io.required(Field{"fans", "all local winds"}, air.fans);
  }
};

struct State {
  std::uint64_t tick = 0;
  double time = 0;  ///< simulated [s]
  bool paused = false;
  Policy policy = Policy::everybody;
  double speed = 1, pace = 1, softness = 1;
  double budget_ms = 0;
  OverBudget over_budget = OverBudget::slow;
  std::string scene;
  double tick_rate = 60;
  Vec3 gravity{};
  Air air;
  std::string fabric, solver;
  std::vector<FabricChange> fabrics;  ///< of each cloth, every value
  std::uint32_t substeps = 0;
  std::uint32_t particles = 0;
  double step_ms = 0;
  double real_time_factor = 0;
  Sleeping sleeping;
  Guarantee guarantee;
  std::optional<Crossings> crossings;  ///< as last counted
  Strain strain;
  Energy energy;
  std::optional<EnergyBalance> balance;  ///< while a viewer wants it

  static constexpr const char* kOp = "state";
  static void describe(auto& io, auto& state) {
    io.required(Field{"tick", ""}, state.tick);
    io.required(Field{"time", "simulated", {}, "s"}, state.time);
    io.required(Field{"paused", ""}, state.paused);
    io.required(Field{"policy", "who may hold the cloth"}, state.policy);
    io.required(Field{"speed", "simulated time per real time that was asked for"}, state.speed);
    io.required(Field{"pace", "fraction of `speed` at which time passes"}, state.pace);
    io.required(Field{"softness", "fraction of their stiffness that the springs have"},
                state.softness);
    io.required(Field{"budget_ms", "for each tick that is due; 0: no bound", {}, "ms"},
                state.budget_ms);
    io.required(Field{"over_budget", "what gives way beyond it"}, state.over_budget);
    io.required(Field{"scene", "its name"}, state.scene);
    io.required(Field{"tick_rate", "", {}, "1/s"}, state.tick_rate);
    io.required(Field{"gravity", "acceleration", {}, "m/s²"}, state.gravity);
    Air::describe(io, state.air);
    io.required(Field{"fabric", "names of all cloths' fabrics"}, state.fabric);
    io.required(Field{"fabrics", "of each cloth, every value; without `preset` if it is of none"},
                state.fabrics);
    io.required(Field{"solver", "its name"}, state.solver);
    io.required(Field{"substeps", "of the last tick"}, state.substeps);
    io.required(Field{"particles", "of all cloths"}, state.particles);
    io.required(Field{"step_ms", "median time of a tick", {}, "ms"}, state.step_ms);
    io.required(Field{"real_time_factor", "simulated per real time that is reached"},
                state.real_time_factor);
    io.required(Field{"sleeping", "cloths at rest, which are not stepped"}, state.sleeping);
    io.required(Field{"guarantee", "whether the promise holds that cloth passes through nothing"},
                state.guarantee);
    io.nullable(Field{"crossings", "as last counted; null before the first count"},
                state.crossings);
    io.required(Field{"strain", "of the springs"}, state.strain);
    io.required(Field{"energy", ""}, state.energy);
    io.optional(Field{"balance", "of energy; while it is measured: see the query `balance`"},
                state.balance);
  }
};

struct ViewerInfo {
  ViewerId id = 0;
  std::string name, color;
  Role role = Role::viewer;
  bool hand = true;
  std::optional<Camera> camera;
  static constexpr const char* kName = "Viewer";
  static void describe(auto& io, auto& viewer) {
    io.required(Field{"id", "its number"}, viewer.id);
    io.required(Field{"name", ""}, viewer.name);
    io.required(Field{"color", "`#rrggbb`"}, viewer.color);
    io.required(Field{"role", "what it may do"}, viewer.role);
    io.required(Field{"hand", "whether it may hold the cloth"}, viewer.hand);
    io.nullable(Field{"camera", "where it looks from, as last told"}, viewer.camera);
  }
};

/// What is new of where a viewer points and looks.
struct PresenceInfo {
  ViewerId viewer = 0;
  std::optional<Vec3> cursor;
  bool away = false;
  std::optional<Camera> camera;
  std::optional<ViewerId> follows;
  static constexpr const char* kName = "Presence";
  static void describe(auto& io, auto& presence) {
    io.required(Field{"viewer", "of which something is new"}, presence.viewer);
    io.optional(Field{"cursor", "what it points at", {}, "m"}, presence.cursor);
    io.flag(Field{"away", "it points at nothing any more"}, presence.away, false);
    io.optional(Field{"camera", "where it looks from; only while others see by it"},
                presence.camera);
    io.optional(Field{"follows", "by whose camera it sees now; 0: its own"}, presence.follows);
  }
};

struct PinInfo {
  std::uint32_t id = 0;
  ViewerId viewer = 0;
  std::uint32_t particle = 0;
  double radius = 0;
  Vec3 position{};
  std::uint32_t count = 0;     ///< number of particles held
  std::optional<Vec3> target;  ///< target of a moving pin [m]
  bool behind = false;         ///< its particles lag behind the target
  static constexpr const char* kName = "Pin";
  static void describe(auto& io, auto& pin) {
    io.required(Field{"id", ""}, pin.id);
    io.required(Field{"viewer", "its owner; 0: the scene"}, pin.viewer);
    io.required(Field{"particle", "the centre of its disc"}, pin.particle);
    io.required(Field{"radius", "of the disc", {}, "m"}, pin.radius);
    io.required(Field{"position", "of its particle", {}, "m"}, pin.position);
    io.required(Field{"count", "particles that it holds"}, pin.count);
    io.optional(Field{"target", "of a moving pin", {}, "m"}, pin.target);
    io.only_if(pin.target.has_value(), "moving pins",
               Field{"behind", "whether its particles lag behind"}, pin.behind, true);
  }
};

struct GrabInfo {
  std::uint32_t id = 0;
  ViewerId viewer = 0;     ///< 0: the scene's own
  std::uint32_t drag = 0;  ///< the viewer's number, or the index of the scene's hand
  SurfacePoint point;
  double radius = 0, stiffness = 0, max_force = 0;
  Vec3 held{}, target{};
  DragMode mode = DragMode::live;
  std::optional<Vec3> force;  ///< on the cloth [N]; only in answers to `query`
  static constexpr const char* kName = "Grab";
  static void describe(auto& io, auto& grab) {
    io.required(Field{"id", "the room's number"}, grab.id);
    io.required(Field{"viewer", "its owner; 0: the scene"}, grab.viewer);
    io.required(Field{"drag", "the owner's number"}, grab.drag);
    io.required(kHeldTriangle, grab.point.triangle);
    io.required(kHeldWeights, grab.point.barycentric);
    io.required(Field{"radius", "of the held disc", {}, "m"}, grab.radius);
    io.required(Field{"stiffness", "", {}, "N/m"}, grab.stiffness);
    io.required(Field{"max_force", "", {}, "N"}, grab.max_force);
    io.required(Field{"held", "the point of the cloth", {}, "m"}, grab.held);
    io.required(Field{"target", "where it is pulled to", {}, "m"}, grab.target);
    io.required(Field{"mode", ""}, grab.mode);
    io.optional(Field{"force", "on the cloth; in answers to `query`", {}, "N"}, grab.force);
  }
};

enum class NoticeLevel : std::uint8_t { info, warning, error };
template <>
inline constexpr std::array<const char*, 3> kWords<NoticeLevel> = {"info", "warning", "error"};

struct Notice {
  NoticeLevel level = NoticeLevel::info;
  std::string code, message;
  std::optional<std::uint64_t> tick;
  std::optional<ViewerId> viewer;
  std::optional<std::uint32_t> drag;
  std::optional<std::uint64_t> count;
  std::optional<double> value;

  static constexpr const char* kOp = "notice";
  static void describe(auto& io, auto& notice) {
    io.required(Field{"level", ""}, notice.level);
    io.required(Field{"code", "what has happened"}, notice.code);
    io.required(Field{"message", "for people"}, notice.message);
    io.optional(Field{"tick", "when"}, notice.tick);
    io.optional(Field{"viewer", "that caused it"}, notice.viewer);
    io.optional(Field{"drag", "of `lease_expired`"}, notice.drag);
    io.optional(Field{"count", "of `frames_dropped`"}, notice.count);
    io.optional(Field{"value", "that holds now"}, notice.value);
  }
};

struct Bye {
  std::uint16_t code = 1001;  ///< the close code that follows
  std::string reason;

  static constexpr const char* kOp = "bye";
  static void describe(auto& io, auto& bye) {
    io.required(Field{"code", "the close code that follows"}, bye.code);
    io.required(Field{"reason", "for people"}, bye.reason);
  }
};

std::string encode_welcome(const Welcome& welcome);
std::string encode_mesh(const MeshAnnouncement& mesh);
std::string encode_state(const State& state);
std::string encode_roster(const std::vector<ViewerInfo>& viewers);
std::string encode_presence(const std::vector<PresenceInfo>& viewers);
std::string encode_pins(std::uint64_t tick, const std::vector<PinInfo>& pins);
std::string encode_grabs(std::uint64_t tick, const std::vector<GrabInfo>& grabs);
std::string encode_notice(const Notice& notice);
std::string encode_bye(const Bye& bye);

/// Path of a mesh over HTTP, e.g. "/api/v1/mesh/4fd1c2a09b7e6d35".
std::string mesh_url(std::uint64_t hash);

}  // namespace weft::proto
