#pragma once

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

/// Runs a callable through an executor, or serially if there is none.
template <class Work>
void run_chunks(Executor* executor, int chunks, Work&& work) {
  if (!executor) {
    for (int chunk = 0; chunk < chunks; ++chunk) work(chunk);
    return;
  }
  executor->run(
      chunks, [](void* context, int chunk) { (*static_cast<Work*>(context))(chunk); }, &work);
}

}  // namespace weft
