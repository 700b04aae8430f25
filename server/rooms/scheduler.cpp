#include "server/rooms/scheduler.h"

#include <algorithm>
#include <utility>

#include "server/thread_priority.h"
#include "server/work_limit.h"

namespace weft::server {
namespace {

/// Threads that ticks of this cost would keep busy [1].
double demand_of(double tick_cost, double interval) {
  if (interval == kNever) return 0;
  return interval > 0 ? tick_cost / interval : 1;
}

thread_local bool on_patient = false;
thread_local double free_until = 0;  // for which this thread need not give way [s]

}  // namespace

Scheduler::Scheduler(int threads, Clock clock, double longest_way)
    : threads_(threads), clock_(std::move(clock)), longest_way_(longest_way) {
  for (int k = 0; k < threads; ++k) {
    workers_.emplace_back([this] {
      be_prompt();
      work(prompt);
    });
    workers_.emplace_back([this] {
      on_patient = true;
      work(patient);
    });
  }
}

Scheduler::~Scheduler() {
  stop();
}

void Scheduler::add(std::shared_ptr<Turns> turns) {
  const std::lock_guard lock(mutex_);
  turns->due_ = clock_();
  all_.push_back(std::move(turns));
  judge();
  look_ahead();
  call(prompt);
}

void Scheduler::remove(const Turns& turns) {
  const std::lock_guard lock(mutex_);
  for (const std::shared_ptr<Turns>& each : all_) {
    if (each.get() != &turns) continue;
    each->removed_ = each->woken_ = true;
    each->due_ = clock_();
    call(lane_of(*each));
  }
  look_ahead();
}

void Scheduler::wake(Turns& turns) {
  const std::lock_guard lock(mutex_);
  turns.woken_ = true;
  if (turns.running_) return;  // seen at its end
  turns.due_ = std::min(turns.due_, clock_());
  call(lane_of(turns));
  look_ahead();
}

void Scheduler::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  for (Waiting& lane : waiting_) lane.arrived.notify_all();
  way_.notify_all();
}

double Scheduler::overdue(const Turns& turns) const {
  const std::lock_guard lock(mutex_);
  return std::max(0.0, clock_() - (turns.running_ ? turns.begun_ : turns.due_));
}

bool Scheduler::is_heavy(const Turns& turns) const {
  const std::lock_guard lock(mutex_);
  return turns.heavy_;
}

void Scheduler::work(Lane lane) {
  std::unique_lock lock(mutex_);
  double cpu = thread_cpu_seconds();
  while (!stopped_) {
    std::shared_ptr<Turns> next = pick(lane, clock_());
    if (!next) {
      wait(lane, lock);
      continue;
    }
    run(lane, next, cpu, lock);
    if (!next->removed_) continue;
    lock.unlock();  // this may be the last pointer to it, and a world takes long to destroy
    next.reset();
    lock.lock();
  }
}

/// Until something is due, or a call. Only one thread of a lane waits for the time, so that a
/// server with one room wakes one.
void Scheduler::wait(Lane lane, std::unique_lock<std::mutex>& lock) {
  Waiting& here = waiting_[lane];
  const double due = earliest(lane);
  ++here.threads;
  if (due < here.deadline) {
    here.deadline = due;
    here.arrived.wait_until(lock, time_point_of(due));
    here.deadline = kNever;
  } else {
    here.arrived.wait(lock);
  }
  --here.threads;
}

/// Wakes a thread that waits.
void Scheduler::call(Lane lane) {
  if (waiting_[lane].threads > 0) waiting_[lane].arrived.notify_one();
}

bool Scheduler::on_patient_thread() {
  return on_patient;
}

void Scheduler::give_way() {
  const double now = clock_();
  if (now < crowded_.load(std::memory_order_relaxed) || now < free_until) return;
  std::unique_lock lock(mutex_);
  --going_;
  look_ahead();
  const double last = now + longest_way_;
  const auto crowded = [&] { return !stopped_ && clock_() >= crowded_from(going_ + 1); };
  while (crowded() && clock_() < last) way_.wait_until(lock, time_point_of(last));
  if (crowded()) free_until = clock_() + kLeastRun;
  ++going_;
  look_ahead();
}

/// From when light rooms will need so many threads that one of the heavy ones has to give way [s].
/// @param going  turns of heavy rooms that do not
double Scheduler::crowded_from(int going) {
  int left = threads_ - going;  // threads, for light rooms
  dues_.clear();
  for (const std::shared_ptr<Turns>& each : all_) {
    if (each->running_)
      left -= each->gives_way_ ? 0 : 1;
    else if (lane_of(*each) == prompt && !each->heavy_)
      dues_.push_back(each->due_);
  }
  if (left < 0) return -kNever;
  if (left >= static_cast<int>(dues_.size())) return kNever;
  const auto last = dues_.begin() + left;  // that has none any more
  std::nth_element(dues_.begin(), last, dues_.end());
  return *last - kWayAhead;
}

/// Call after anything has changed of what is due or runs.
void Scheduler::look_ahead() {
  const double from = going_ > 0 ? crowded_from(going_) : kNever;
  crowded_.store(from, std::memory_order_relaxed);
  way_.notify_all();
}

/// Light ones by when they are due, heavy ones by what they have had.
std::shared_ptr<Turns> Scheduler::pick(Lane lane, double now) const {
  const auto key = [](const Turns& turns) { return turns.heavy_ ? turns.served_ : turns.due_; };
  const std::shared_ptr<Turns>* best = nullptr;
  for (const std::shared_ptr<Turns>& each : all_) {
    if (each->running_ || each->due_ > now || lane_of(*each) != lane) continue;
    const bool first =
        best == nullptr ||
        (each->heavy_ == (*best)->heavy_ ? key(*each) < key(**best) : (*best)->heavy_);
    if (first) best = &each;
  }
  return best == nullptr ? nullptr : *best;
}

double Scheduler::earliest(Lane lane) const {
  double due = kNever;
  for (const std::shared_ptr<Turns>& each : all_)
    if (!each->running_ && lane_of(*each) == lane) due = std::min(due, each->due_);
  return due;
}

/// @param spent  CPU time of this thread until the end of the last turn, and of this one [s]
void Scheduler::run(Lane lane, const std::shared_ptr<Turns>& turns, double& spent,
                    std::unique_lock<std::mutex>& lock) {
  turns->running_ = true;
  turns->woken_ = false;
  turns->gives_way_ = lane == patient;
  turns->begun_ = clock_();
  const bool ends = turns->removed_;
  if (waiting_[lane].deadline == kNever && earliest(lane) < kNever) call(lane);
  ++running_;
  if (lane == patient) ++going_;
  look_ahead();
  lock.unlock();
  const double before = spent;
  Turn turn;
  if (ends)
    turns->end();
  else
    turn = turns->turn();
  spent = thread_cpu_seconds();
  const double cpu = spent - before;
  if (!ends) turns->note_cpu(cpu);
  lock.lock();
  --running_;
  if (lane == patient) --going_;
  turns->running_ = false;
  if (ends)
    std::erase(all_, turns);
  else
    book(*turns, turn, cpu);
  judge();
  look_ahead();
  // It may also have moved during this turn, when a thread of its new lane found it running.
  if (lane_of(*turns) != lane) call(lane_of(*turns));
}

void Scheduler::book(Turns& turns, const Turn& turn, double cpu) {
  turns.served_ += cpu;
  if (turn.ticked)
    turns.tick_cost_ += kCostMemory * (cpu - turns.tick_cost_);
  else if (turn.interval == 0)
    turns.tick_cost_ = cpu;
  turns.demand_ = demand_of(turns.tick_cost_, turn.interval);
  turns.due_ = turns.woken_ ? clock_() : turn.next;
}

/// Tells light rooms from heavy ones. What one room wants changes the shares of all, so any of them
/// may change its lane, whose threads then look anew.
void Scheduler::judge() {
  int busy = 0;
  double least_served = kNever;
  for (const std::shared_ptr<Turns>& each : all_) {
    busy += each->demand_ > 0 ? 1 : 0;
    if (each->demand_ > 0) least_served = std::min(least_served, each->served_);
  }
  const double share = static_cast<double>(threads_) / std::max(busy, 1);
  bool light = false;
  for (const std::shared_ptr<Turns>& each : all_) {
    each->heavy_ = each->demand_ > share && each->tick_cost_ > kShortTick;
    // What it left unused while it stood is not saved up.
    if (each->demand_ == 0 && least_served < kNever)
      each->served_ = std::max(each->served_, least_served);
    light = light || (!each->heavy_ && (each->running_ || each->due_ < kNever));
  }
  bool moved = false;
  for (const std::shared_ptr<Turns>& each : all_) {
    const bool after = each->heavy_ && light;
    moved = std::exchange(each->patient_, after) != after || moved;
  }
  if (!moved) return;
  for (const Lane lane : {prompt, patient}) call(lane);
}

}  // namespace weft::server
