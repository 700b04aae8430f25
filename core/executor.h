#pragma once

#include "core/stop_signal.h"

namespace weft {

/// Runs independent chunks of work, on whatever threads its owner has. The physics owns no thread:
/// it is given one of these, or none and then works through the chunks one after the other. Chunks
/// never depend on the number of threads, and their results are merged in their order.
class Executor {
 public:
  virtual ~Executor() = default;

  /// Calls work(context, chunk) for each chunk from 0 to chunks - 1, in any order and on any
  /// threads, and returns when all are done.
  virtual void run(int chunks, void (*work)(void* context, int chunk), void* context) = 0;
};

namespace detail {
inline constinit thread_local bool runs_serially = false;
}

/// While it lives, chunks of this thread run one after the other: for work beside the thread whose
/// executor it is.
class SerialScope {
 public:
  SerialScope() : outer_(detail::runs_serially) { detail::runs_serially = true; }
  ~SerialScope() { detail::runs_serially = outer_; }
  SerialScope(const SerialScope&) = delete;
  SerialScope& operator=(const SerialScope&) = delete;

 private:
  bool outer_;
};

/// Runs a callable through an executor, or serially if there is none. A stop point lies between
/// chunks; with an executor it lies behind the last one, because no chunk may throw there.
template <class Work>
void run_chunks(Executor* executor, int chunks, Work&& work) {
  if (!executor || detail::runs_serially) {
    for (int chunk = 0; chunk < chunks; ++chunk) {
      stop_point();
      work(chunk);
    }
    return;
  }
  {
    const StopScope whole(nullptr);
    executor->run(
        chunks, [](void* context, int chunk) { (*static_cast<Work*>(context))(chunk); }, &work);
  }
  stop_point();
}

}  // namespace weft
