#include "server/room/scene_build.h"

#include <string>
#include <utility>

#include "core/error.h"
#include "core/world/cost.h"
#include "core/world/effective_moduli.h"
#include "core/world/implicit_alone.h"
#include "core/world/mesh_damping.h"
#include "core/world/object_repair.h"
#include "core/world/pin_extent.h"
#include "core/world/spring_hold.h"
#include "server/constants.h"
#include "server/room/shared_meshes.h"
#include "server/translate/translate_mesh.h"

namespace weft::server {
namespace {

/// Throws CostError if each viewer that joins would have to be sent too much.
void check_mesh_bytes(const WorldDef& def) {
  const std::size_t bytes = proto::mesh_data_bytes(mesh_size(def));
  if (bytes <= kMostMeshBytes) return;
  throw CostError("scene", "a mesh message of " + std::to_string(bytes) + " bytes",
                  "at most " + std::to_string(kMostMeshBytes) + " bytes, which each viewer is sent",
                  "use fewer or coarser meshes");
}

}  // namespace

template <class Real>
ComingStarts look_ahead(const World<Real>& world, double tick_limit) {
  WorkLimit limit(tick_limit);
  // The thread's own signal still ends the build, without an answer.
  StopSignal* const outer = current_stop_signal();
  limit.signal().attend = [&limit, outer] { return limit.is_over() || (outer && outer->raised()); };
  limit.signal().raise();
  try {
    const WorkLimit::Scope scope(limit);
    return world.coming_bad_starts();
  } catch (const Stopped&) {
    if (outer && outer->raised()) throw;
    return {};
  }
}

template <class Real>
std::vector<SceneNotice> notices_of(const World<Real>& world,
                                    const std::vector<std::string>& repairs) {
  std::vector<SceneNotice> notices;
  for (const std::string& repair : repairs) notices.push_back({"mesh_repaired", repair});
  for (const SlackSprings& slack : slack_springs(world))
    notices.push_back({"springs_slack", describe(slack)});
  for (const std::string& softer : describe(effective_moduli(world)))
    notices.push_back({"softer_than_fabric", softer});
  if (steps_implicit_alone(world))
    notices.push_back({"implicit_alone", describe_implicit_alone(world)});
  if (const auto pins = coarse_pins(world); !pins.empty())
    notices.push_back({"pins_coarse", describe(pins), false});
  for (const MeshDamping& damping : damping_of_meshes(world))
    notices.push_back({"damping_of_mesh", describe(damping), false});
  return notices;
}

BuiltScene build_scene(const WorldDef& def, Executor* executor, double tick_limit) {
  // Worlds are built on any thread, and use it again when their fabric changes.
  static SharedMeshes meshes;
  const SerialScope serial;
  check_size(def);
  check_mesh_bytes(def);
  Runtime runtime;
  runtime.executor = executor;
  runtime.clock = &process_seconds;
  runtime.meshes = &meshes;
  BuiltScene built;
  WorldDef repaired = def;
  const std::vector<std::string> repairs = repair_objects(repaired);
  built.world = std::make_unique<ServedWorld>(repaired, runtime);
  check_cost(built.world->cost_in(def.environment), "scene", def.name);
  built.notices = notices_of(*built.world, repairs);
  stop_point();
  proto::SceneMesh mesh = scene_mesh(*built.world);
  built.mesh = mesh_announcement(*built.world);
  built.order = give_order(mesh, built.mesh);
  stop_point();
  proto::Bytes bytes = proto::encode_mesh_data(mesh);
  built.mesh.hash = proto::content_hash(bytes);
  built.mesh.bytes = bytes.size();
  built.mesh_bytes = SharedBytes(std::move(bytes));
  built.bad_starts = look_ahead(*built.world, tick_limit);
  return built;
}

void SceneBuild::run() {
  try {
    const LimitWatch watch(limit_);
    limit_.signal().attend = [this] {
      if (!cancelled()) limit_.signal().lower();
      return cancelled() || limit_.is_over();
    };
    if (cancelled()) limit_.signal().raise();
    const WorkLimit::Scope scope(limit_);
    scene_ = make_();
  } catch (...) {
    failure_ = std::current_exception();
  }
  done_.store(true, std::memory_order_release);
}

void SceneBuild::cancel() {
  cancelled_.store(true, std::memory_order_release);
  limit_.signal().raise();
}

BuiltScene SceneBuild::take() {
  if (failure_) std::rethrow_exception(failure_);
  return std::move(*scene_);
}

#define WEFT_INSTANTIATE(Real)                                  \
  template ComingStarts look_ahead(const World<Real>&, double); \
  template std::vector<SceneNotice> notices_of(const World<Real>&, const std::vector<std::string>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft::server
