// How a room loads another scene: it is built beside the running one.

#include <cassert>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/room/refusals.h"
#include "server/room/room.h"

namespace weft::server {
namespace {

using proto::ErrorCode;
using proto::make_error;
using proto::ViewerId;

}  // namespace

WorldDef Room::definition_of(const std::string& scene) const {
  WorldDef def = scenes_(scene);
  def.name = scene;
  if (options_.tick_rate > 0) def.tick_rate = options_.tick_rate;
  return def;
}

/// The scene that a `load` asks for. Runs on another thread: reads nothing that changes.
WorldDef Room::definition_of(const std::string& name, const std::string& json) const {
  if (json.empty()) return definition_of(name);
  try {
    WorldDef def = options_.read_scene(json);
    if (options_.tick_rate > 0) def.tick_rate = options_.tick_rate;
    return def;
  } catch (const CostError&) {
    throw;  // is reported as it is
  } catch (const DefinitionError& error) {
    const std::string field = error.field == "scene" ? error.field : "scene." + error.field;
    throw error.renamed(field);
  }
}

/// The previous scene runs on until the new one is ready.
Room::Outcome Room::apply(ViewerId viewer, const proto::Load& command) {
  if (!command.definition.empty() && !options_.read_scene)
    return make_error(ErrorCode::not_supported, "this server takes scenes by name only");
  if (command.definition.empty()) {
    if (auto error = check_scene_name(command.scene, options_.scene_names))
      return *std::move(error);
  }
  start_build(viewer, [this, name = command.scene, json = command.definition] {
    return definition_of(name, json);
  });
  return proto::Reply(proto::LoadReply{});
}

/// Announces the new scene to all viewers.
void Room::tell_loaded(ViewerId viewer) {
  if (order_.advance) end_advance(ErrorCode::interrupted, "a viewer loaded a scene", "");
  time_.drop_steps();
  time_.restart_meter(clock_());
  for (const auto& [id, entry] : viewers_) send_mesh(id, entry);
  news_.replace();
  frames_.note_jump();
  notify(proto::NoticeLevel::info, "loaded", "the scene is now " + world_->def().name, viewer);
  for (const SceneNotice& notice : scene_notices_)
    notify(proto::NoticeLevel::warning, notice.code, notice.message);
  tell_guarantee();
  tell_changes();
}

void Room::start_build(proto::ViewerId viewer, std::function<WorldDef()> definition) {
  Executor* const executor = executor_;
  const double limit = options_.limit ? options_.limit->seconds() : 0;
  assert(!order_.building);  // all that builds waits for what is being built
  order_.building.emplace();
  order_.building->viewer = viewer;
  order_.building->build =
      std::make_shared<SceneBuild>([definition = std::move(definition), executor,
                                    limit] { return build_scene(definition(), executor, limit); },
                                   options_.build_limit);
  options_.beside([build = order_.building->build] { build->run(); });
}

/// Takes a scene that has been built.
void Room::finish_build() {
  if (!order_.building || !order_.building->build->done()) return;
  const Building done = std::move(*order_.building);
  order_.building.reset();
  try {
    done.name ? open_room(done) : replace_scene(done);
    if (const auto found = viewers_.find(done.viewer);
        found != viewers_.end() && viewers_.size() > 1)
      found->second.next_turn = clock_() + kPauseAfterLoad;
  } catch (const DefinitionError& error) {
    refuse(done.viewer, done.request, to_wire(error));
  } catch (const Stopped&) {
    refuse(done.viewer, done.request,
           proto::make_error(proto::ErrorCode::too_costly,
                             "building this scene takes more than " +
                                 proto::number_text(options_.build_limit) + " s of CPU",
                             "take fewer particles or triangles"));
  } catch (const std::exception& error) {
    spdlog::error("{}: {}", proto::name_of(done.request.command), error.what());
    refuse(done.viewer, done.request,
           proto::make_error(proto::ErrorCode::internal, "the server failed at this command",
                             "the previous scene keeps running"));
  }
}

/// Throws what building threw.
void Room::replace_scene(const Building& done) {
  BuiltScene scene = done.build->take();
  const TickCost cost = scene.world->cost_in(scene.world->environment());
  if (options_.others) {
    if (auto error = options_.others->admit(options_.name, cost))
      return refuse(done.viewer, done.request, *std::move(error));
  }
  const std::uint64_t tick = world_->tick();
  start_world(std::move(scene));
  order_.log.add(tick, done.viewer, CommandOrigin::viewer, done.request.command);
  tell_loaded(done.viewer);
  answer(done.viewer, done.request.id, proto::LoadReply{0, world_->def().name, epoch_});
}

}  // namespace weft::server
