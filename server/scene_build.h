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
#include "server/translate.h"
#include "server/work_limit.h"

namespace weft::server {

/// What is or comes where it should not be until the first tick of a world is done, if it can be
/// told within the limit.
/// @param tick_limit  CPU time [s]
ComingStarts look_ahead(const ServedWorld& world, double tick_limit);

/// What people should know of a scene as it was built.
struct SceneNotice {
  const char* code;  ///< of the notice
  std::string message;
};

/// Everything about a scene that takes long to make and may fail: what is left when it takes the
/// place of another one cannot.
struct BuiltScene {
  std::unique_ptr<ServedWorld> world;
  proto::MeshAnnouncement mesh;  ///< but for its epoch
  SharedBytes mesh_bytes;
  ComingStarts bad_starts;           ///< that its first tick finds
  std::vector<SceneNotice> notices;  ///< for people, of its start
};

/// Whatever is to be said of a world at its start beside `repairs` of its objects.
std::vector<SceneNotice> notices_of(const ServedWorld& world,
                                    const std::vector<std::string>& repairs);

/// Builds a scene, and looks one tick ahead for what starts where it should not be. Throws
/// DefinitionError where it cannot be built or would cost too much, and Stopped where a stop signal
/// of the thread ended it.
/// @param executor    that its world will use; not used meanwhile
/// @param tick_limit  of CPU for the tick ahead, beyond which nothing is known of it [s]; 0: none
BuiltScene build_scene(const WorldDef& def, Executor* executor, double tick_limit);

/// A scene that is being built, on whatever thread. Its maker keeps it until it is `done`.
class SceneBuild {
 public:
  /// @param make     called once, by `run`
  /// @param seconds  of CPU that it may take [s]; 0: no bound
  SceneBuild(std::function<BuiltScene()> make, double seconds)
      : make_(std::move(make)), limit_(seconds) {}

  /// Builds. Keeps what is thrown.
  void run();
  /// Makes `run` end soon. From any thread.
  void cancel();

  bool done() const { return done_.load(std::memory_order_acquire); }
  bool cancelled() const { return cancelled_.load(std::memory_order_acquire); }
  /// What was built, once it is done. Throws what building threw.
  BuiltScene take();

 private:
  std::function<BuiltScene()> make_;
  WorkLimit limit_;
  std::optional<BuiltScene> scene_;
  std::exception_ptr failure_;
  std::atomic<bool> done_ = false, cancelled_ = false;
};

}  // namespace weft::server
