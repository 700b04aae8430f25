#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "server/clock.h"

namespace weft::server {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// What a turn leaves to do.
struct Turn {
  double next = kNever;      ///< when the next one is due [s]; never: not before it is woken
  double interval = kNever;  ///< between ticks [s]; 0: as many as possible; never: none pass
  bool ticked = false;       ///< whether this turn passed a tick
};

/// Something that is given turns, one at a time, on any thread of a scheduler.
class Turns {
 public:
  Turns() = default;
  Turns(const Turns&) = delete;
  Turns& operator=(const Turns&) = delete;
  virtual ~Turns() = default;

  virtual Turn turn() = 0;
  /// Called once, after the last turn.
  virtual void end() = 0;

 private:
  friend class Scheduler;

  // Under the scheduler's lock.
  double due_ = kNever;   ///< [s]
  double begun_ = 0;      ///< the turn that runs [s]
  double served_ = 0;     ///< CPU so far, and for each pause what others got in it [s]
  double tick_cost_ = 0;  ///< of CPU, mean of the last ticks [s]
  double demand_ = 0;     ///< threads that its ticks would keep busy [1]
  bool running_ = false, woken_ = false, removed_ = false;
  bool heavy_ = false;    ///< wants more than its share
  bool patient_ = false;  ///< is served after light ones
};

/// Gives rooms their turns on a few threads, each room on one at a time.
///
/// A room is light if its ticks take at most an equal share of the threads, or next to nothing;
/// light rooms are served in the order in which they are due. As long as there are any, heavy ones
/// run on threads of their own, which the system serves after the others, and among each other by
/// the CPU time that they have had. So a room that overruns slows itself alone: the others lose
/// neither a thread to it, nor more than the system takes to switch.
class Scheduler {
 public:
  /// @param threads  for light rooms; as many wait for heavy ones
  Scheduler(int threads, Clock clock);
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// Its first turn is due at once.
  void add(std::shared_ptr<Turns> turns);
  /// It gets no more turns, and its `end` soon.
  void remove(const Turns& turns);
  /// Its next turn is due at once, also if one is running. Callable from any thread.
  void wake(Turns& turns);
  /// No turn begins any more.
  void stop();

  /// Turns under way. Callable from any thread.
  int running() const { return running_.load(std::memory_order_relaxed); }
  /// Time since a turn was due or, if it runs, since it began [s]; at least 0.
  double overdue(const Turns& turns) const;
  /// Whether it wants more than its share.
  bool is_heavy(const Turns& turns) const;

 private:
  enum Lane : std::uint8_t { prompt, patient };
  struct Waiting {
    std::condition_variable arrived;
    int threads = 0;
    double deadline = kNever;  ///< at which one of them looks again [s]
  };

  void work(Lane lane);
  void wait(Lane lane, std::unique_lock<std::mutex>& lock);
  void run(Lane lane, const std::shared_ptr<Turns>& turns, std::unique_lock<std::mutex>& lock);
  void book(Turns& turns, const Turn& turn, double cpu);
  void judge();
  static Lane lane_of(const Turns& turns) { return turns.patient_ ? patient : prompt; }
  std::shared_ptr<Turns> pick(Lane lane, double now) const;
  double earliest(Lane lane) const;
  void call(Lane lane);

  const int threads_;
  Clock clock_;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Turns>> all_;
  std::array<Waiting, 2> waiting_;
  bool stopped_ = false;
  std::atomic<int> running_ = 0;
  std::vector<std::jthread> workers_;
};

}  // namespace weft::server
