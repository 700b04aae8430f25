#include "server/rooms/scene_builders.h"

#include <utility>

namespace weft::server {

SceneBuilders::SceneBuilders(int threads) {
  for (int k = 0; k < threads; ++k)
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
}

SceneBuilders::~SceneBuilders() {
  for (std::jthread& thread : threads_) thread.request_stop();
}

void SceneBuilders::start(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  arrived_.notify_one();
}

bool SceneBuilders::idle() const {
  const std::lock_guard lock(mutex_);
  return jobs_.empty() && running_ == 0;
}

void SceneBuilders::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (arrived_.wait(lock, stop, [this] { return !jobs_.empty(); })) {
    std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    ++running_;
    lock.unlock();
    job();
    job = nullptr;  // and what it kept alive, without the lock
    lock.lock();
    --running_;
  }
}

}  // namespace weft::server
