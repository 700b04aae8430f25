#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/executor.h"
#include "server/message.h"
#include "server/room/room_past.h"
#include "server/translate/translate.h"
#include "server/work_limit.h"

namespace weft::server {

/// Finds crossings and penetrations that exist at the start or arise in the first tick of a world,
/// if that takes no longer than the limit.
/// @param tick_limit  CPU time [s]
template <class Real>
ComingStarts look_ahead(const World<Real>& world, double tick_limit);

/// A remark on a scene as built, for viewers.
struct SceneNotice {
  const char* code;  ///< of the notice
  std::string message;
  bool warns = true;  ///< otherwise it informs
};

/// Everything about a scene that takes long to make and may fail; the replacement of the old scene
/// that remains cannot fail.
struct BuiltScene {
  std::unique_ptr<ServedWorld> world;
  proto::MeshAnnouncement mesh;  ///< without its epoch
  SharedBytes mesh_bytes;
  std::shared_ptr<const proto::codec::CodingOrder> order;  ///< of packed frames
  ComingStarts bad_starts;                                 ///< found by its first tick
  std::vector<SceneNotice> notices;                        ///< of its start
  std::optional<RoomPast> past;                            ///< of a fork, which has no start
};

/// All remarks on a world at its start, including the `repairs` of its objects.
template <class Real>
std::vector<SceneNotice> notices_of(const World<Real>& world,
                                    const std::vector<std::string>& repairs);

/// Builds a scene, and looks one tick ahead for bad starts. Throws DefinitionError if it cannot be
/// built or would cost too much, and Stopped if a stop signal of the thread ended it.
/// @param executor    for its world; idle in the meantime
/// @param tick_limit  CPU time of the look-ahead, beyond which nothing is known of it [s]; 0: none
BuiltScene build_scene(const WorldDef& def, Executor* executor, double tick_limit);

/// A scene under construction, on any thread. Its maker keeps it until it is `done`.
class SceneBuild {
 public:
  /// @param make     called once, by `run`
  /// @param seconds  most CPU time [s]; 0: no bound
  SceneBuild(std::function<BuiltScene()> make, double seconds)
      : make_(std::move(make)), limit_(seconds) {}

  /// Builds the scene. Stores an exception.
  void run();
  /// Makes `run` end soon. Callable from any thread.
  void cancel();

  bool done() const { return done_.load(std::memory_order_acquire); }
  /// Whether there is a scene to take: a build that failed replaces nothing.
  bool succeeded() const { return done() && !failure_; }
  bool cancelled() const { return cancelled_.load(std::memory_order_acquire); }
  /// The result, once it is done. Throws what building threw.
  BuiltScene take();

 private:
  std::function<BuiltScene()> make_;
  WorkLimit limit_;
  std::optional<BuiltScene> scene_;
  std::exception_ptr failure_;
  std::atomic<bool> done_ = false, cancelled_ = false;
};

}  // namespace weft::server
