#pragma once

#include <cstdint>

#include "core/executor.h"
#include "server/scene/scene_library.h"
#include "tests/fuzz/script.h"

namespace weft::fuzz {

/// What a run may take, in CPU time.
struct Limits {
  double tick = 2;     ///< of one tick, which the room gives up beyond it [s]
  double grace = 0.5;  ///< in which it ends such a tick [s]
  double wait = 1;     ///< of what is done between two ticks, e.g. one command [s]
  double build = 30;   ///< of building a scene, which the room gives up beyond it [s]
  double hang = 60;    ///< of any of them, until the run is ended [s]
  double scene = 3;    ///< of the whole run, after which no further step begins [s]
};

/// What a run has shown. Plain bytes that stand in memory shared with the process that judges, so
/// that what is known when a run crashes is not lost.
struct Outcome {
  char doing[160];    ///< at present: the step and what it is
  bool begun, ended;  ///< the scene was built; the run came to its end
  char refused[240];  ///< why the scene was not taken; empty if it was
  bool bare_refusal;  ///< the refusal lacks field or limit
  std::uint64_t steps, commands, errors, ticks;
  double cpu, longest_tick, longest_wait, longest_build;  ///< [s]
  char longest_wait_in[32];
  std::uint64_t ticks_over, waits_over;  ///< beyond their limits
  std::uint64_t recoveries;              ///< blow-ups that were seen
  std::uint64_t halts;
  char halt[120];          ///< the last one, as its command in the log
  std::uint64_t problems;  ///< of the kinds below and any other
  char problem[240];       ///< the first one, in words
  std::uint64_t not_finite_energy, not_finite_frames, false_promises, internal_errors;
  std::uint64_t hash;  ///< at the end
};

/// Runs a script in a room with a clock of its own and no socket, and checks at each step what must
/// hold whatever is done.
/// @param most_steps  after which it ends
/// @param executor    of the physics; null: one thread
void run_script(const Script& script, const server::SceneLibrary& library, const Limits& limits,
                std::uint64_t most_steps, Outcome& outcome, Executor* executor = nullptr);

/// Exit code of a process whose step took longer than it may.
inline constexpr int kHangExit = 97;

}  // namespace weft::fuzz
