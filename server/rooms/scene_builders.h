#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace weft::server {

/// A few threads that build scenes for rooms, in the order in which these asked.
class SceneBuilders {
 public:
  explicit SceneBuilders(int threads);
  ~SceneBuilders();
  SceneBuilders(const SceneBuilders&) = delete;
  SceneBuilders& operator=(const SceneBuilders&) = delete;

  /// Callable from any thread.
  void start(std::function<void()> job);
  /// Whether nothing runs or waits.
  bool idle() const;

 private:
  void work(const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<std::function<void()>> jobs_;
  int running_ = 0;
  std::vector<std::jthread> threads_;
};

}  // namespace weft::server
