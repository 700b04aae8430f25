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
#include "server/constants.h"

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
  /// The CPU time of a turn, at its end [s]: to read its clock takes most of a microsecond.
  virtual void note_cpu(double /*seconds*/) {}

 private:
  friend class Scheduler;

  // Under the scheduler's lock.
  double due_ = kNever;   ///< [s]
  double begun_ = 0;      ///< the turn that runs [s]
  double served_ = 0;     ///< CPU so far, and for each pause what others got in it [s]
  double tick_cost_ = 0;  ///< of CPU, mean of the last ticks [s]
  double demand_ = 0;     ///< threads that its ticks would keep busy [1]
  bool running_ = false, woken_ = false, removed_ = false;
  bool heavy_ = false;      ///< wants more than its share
  bool patient_ = false;    ///< is served after light ones
  bool gives_way_ = false;  ///< the turn that runs does
};

/// Gives rooms their turns on a few threads, each room on one at a time.
///
/// A room is light if its ticks take at most an equal share of the threads, or next to nothing;
/// light rooms are served in the order in which they are due. As long as there are any, heavy ones
/// run on threads of their own, among each other by the CPU time that they have had, and give way
/// in the midst of their turns, shortly before light ones are due that will need all threads. So a
/// room that overruns slows itself alone. It does not depend on the system, which interrupts a
/// thread for another one milliseconds late, nor on priorities, by which a thread would stop for
/// seconds where other programs keep all processors busy, with whatever it has locked.
class Scheduler {
 public:
  /// @param threads      for light rooms; as many wait for heavy ones
  /// @param longest_way  for which a heavy room gives way at most [s]
  Scheduler(int threads, Clock clock, double longest_way = kLongestWay);
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

  /// Whether the calling thread is one that serves heavy rooms after light ones.
  static bool on_patient_thread();
  /// Waits on such a thread until light rooms leave a processor for it, but lets it go on for a
  /// moment now and then however many they are. Cheap if it need not wait. The turn that runs on
  /// the calling thread must not hold what others may need.
  void give_way();

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
  void run(Lane lane, const std::shared_ptr<Turns>& turns, double& spent,
           std::unique_lock<std::mutex>& lock);
  void book(Turns& turns, const Turn& turn, double cpu);
  void judge();
  static Lane lane_of(const Turns& turns) { return turns.patient_ ? patient : prompt; }
  std::shared_ptr<Turns> pick(Lane lane, double now) const;
  double earliest(Lane lane) const;
  void call(Lane lane);
  double crowded_from(int going);
  void look_ahead();

  const int threads_;
  Clock clock_;
  const double longest_way_;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Turns>> all_;
  std::array<Waiting, 2> waiting_;
  bool stopped_ = false;
  int going_ = 0;                         // turns of heavy rooms that do not give way
  std::atomic<double> crowded_ = kNever;  // from when one of them has to [s]
  std::condition_variable way_;
  std::vector<double> dues_;  // of light rooms, for a moment [s]
  std::atomic<int> running_ = 0;
  std::vector<std::jthread> workers_;
};

}  // namespace weft::server
