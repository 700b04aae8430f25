#pragma once

#include <cassert>

#include "core/stop_signal.h"

// Interface to the owner's threads.

namespace weft {

/// Runs independent chunks of work on its owner's threads. The physics owns no thread: it is given
/// an executor, or none and then runs the chunks serially. Chunks never depend on the number of
/// threads, and their results are merged in order.
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

/// During its lifetime, chunks of this thread run serially: for work on a thread that may not use
/// the executor.
class SerialScope {
 public:
  SerialScope() : outer_(detail::runs_serially) { detail::runs_serially = true; }
  ~SerialScope() { detail::runs_serially = outer_; }
  SerialScope(const SerialScope&) = delete;
  SerialScope& operator=(const SerialScope&) = delete;

 private:
  bool outer_;
};

/// Runs a callable through an executor, or serially without one. Stop points lie between chunks;
/// with an executor the stop point follows the last chunk, because a chunk must not throw there.
template <class Work>
void run_chunks(Executor* executor, int chunks, Work&& work) {
  assert(chunks >= 0);
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
