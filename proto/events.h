#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "proto/commands.h"
#include "proto/types.h"

// Messages that the server sends unasked. README.md section 4 gives the meaning of each field.

namespace weft::proto {

/// Limits in force at this server.
struct ServerLimits {
  std::size_t message_bytes = kMostMessageBytes;
  double messages_per_second = 1000;
  std::uint32_t viewers = 64;
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
  std::string name, color, role;
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
};

struct Energy {
  double kinetic = 0, stretch = 0, bending = 0, gravity = 0, total = 0;  ///< [J]
};

/// Cloths at rest, which are not stepped until something acts on them.
struct Sleeping {
  std::uint32_t islands = 0;  ///< groups of touching cloths that sleep and wake together
  std::vector<std::string> cloths;
};

/// Intersections of cloths' edges and triangles, with each other and with objects.
struct Crossings {
  std::uint64_t count = 0;
  std::uint64_t tick = 0;              ///< of the state in which they were counted
  std::optional<double> smallest_gap;  ///< least contact distance then [m]; empty: nothing is near
};

/// Whether the promise of no crossings holds.
enum class GuaranteeState : std::uint8_t {
  held,
  bad_start,  ///< except for features that were crossed at the start
  broken,     ///< an object was forced through the cloth; `void` on the wire
  none,       ///< the contact promises nothing
};

/// The word on the wire.
const char* name_of(GuaranteeState state);

struct Guarantee {
  GuaranteeState state = GuaranteeState::held;
  std::vector<std::string> covers;   ///< the words "objects" and "cloth", as far as it covers them
  std::uint64_t pairs = 0;           ///< number of feature pairs without a promise
  std::vector<std::string> reasons;  ///< in words; none if it is held
};

struct State {
  std::uint64_t tick = 0;
  double time = 0;  ///< simulated [s]
  bool paused = false;
  double speed = 1, pace = 1, softness = 1;
  double budget_ms = 0;
  OverBudget over_budget = OverBudget::slow;
  std::string scene;
  double tick_rate = 60;
  Vec3 gravity{}, wind{};
  double gust_speed = 0, gust_length = 0, air_density = 0;
  bool still_air = false;
  double drag = 0;
  std::vector<Fan> fans;
  std::string fabric, solver;
  std::uint32_t substeps = 0;
  std::uint32_t particles = 0;
  double step_ms = 0;
  double real_time_factor = 0;
  Sleeping sleeping;
  Guarantee guarantee;
  std::optional<Crossings> crossings;  ///< as last counted
  Strain strain;
  Energy energy;
};

struct ViewerInfo {
  ViewerId id = 0;
  std::string name, color, role;
  std::optional<Camera> camera;
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
};

enum class NoticeLevel : std::uint8_t { info, warning, error };

struct Notice {
  NoticeLevel level = NoticeLevel::info;
  std::string code, message;
  std::optional<std::uint64_t> tick;
  std::optional<ViewerId> viewer;
  std::optional<std::uint32_t> drag;
  std::optional<std::uint64_t> count;
  std::optional<double> value;
};

struct Bye {
  std::uint16_t code = 1001;  ///< the close code that follows
  std::string reason;
};

std::string encode_welcome(const Welcome& welcome);
std::string encode_mesh(const MeshAnnouncement& mesh);
std::string encode_state(const State& state);
std::string encode_roster(const std::vector<ViewerInfo>& viewers);
std::string encode_pins(std::uint64_t tick, const std::vector<PinInfo>& pins);
std::string encode_grabs(std::uint64_t tick, const std::vector<GrabInfo>& grabs);
std::string encode_notice(const Notice& notice);
std::string encode_bye(const Bye& bye);

/// 16 hexadecimal digits, the form of hashes in messages and URLs.
std::string hash_text(std::uint64_t hash);

/// Path of a mesh over HTTP, e.g. "/api/v1/mesh/4fd1c2a09b7e6d35".
std::string mesh_url(std::uint64_t hash);

}  // namespace weft::proto
