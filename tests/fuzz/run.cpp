#include "tests/fuzz/run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <sys/time.h>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/world/crossing_counter.h"
#include "server/room/room.h"
#include "tests/fuzz/listener.h"

namespace weft::fuzz {
namespace {

constexpr proto::ViewerId kAuditor = 1000;      // the viewer that asks what every run is asked
constexpr proto::ViewerId kConnection = 10000;  // from one id of a viewer to its next
constexpr int kPatience = 400;                  // turns until an `advance` is ended by its viewer
constexpr int kSettling = 30;                   // turns until everything has been told and answered

double cpu_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Lets SIGPROF come after so much CPU time of the process; 0: never.
void set_alarm(double seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - std::floor(seconds)) * 1e6);
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

/// One script in one room.
class Run {
 public:
  Run(const Script& script, const server::SceneLibrary& library, const Limits& limits,
      Outcome& outcome, Executor* executor)
      : script_(script), library_(library), limits_(limits), outcome_(outcome), executor_(executor),
        listener_(outcome), limit_(limits.tick), watch_(limit_) {}

  void go(std::uint64_t most_steps) {
    if (!build()) return;
    outcome_.begun = true;
    join(kAuditor);
    for (const Step& step : script_.steps) {
      if (outcome_.steps >= most_steps || outcome_.cpu > limits_.scene) break;
      ++outcome_.steps;
      follow(step);
    }
    settle();
    audit();
    count_halts();
    count_answers();
    outcome_.hash = room_->world().hash();
    outcome_.ended = true;
  }

 private:
  /// False if the scene is refused.
  bool build() {
    server::RoomOptions options;
    try {
      options.limit = &limit_;
      options.build_limit = limits_.build;
      options.beside = [this](std::function<void()> job) { jobs_.push_back(std::move(job)); };
      measured("reading the scene", Kind::build, [&] {
        options.scene_def = std::make_shared<const WorldDef>(library_.from_client(script_.scene));
        options.read_scene = [this](const std::string& text) { return library_.from_client(text); };
        const auto named = [this](const std::string& name) { return library_.named(name); };
        room_ =
            std::make_unique<server::Room>(options, named, listener_, clock(), metrics_, executor_);
      });
      limit_.signal().attend = [this] { return attend(); };
      return true;
    } catch (const DefinitionError& error) {
      put(outcome_.refused, error.what());
      outcome_.bare_refusal = error.field.empty() || error.limit.empty();
      return false;
    }
  }

  /// A clock whose time passes by ticks and a little by each look, the same in each run.
  server::Clock clock() {
    return [this] { return now_ += looks_++ % 50 == 0 ? 4e-3 : 1e-4; };
  }

  enum class Kind { tick, wait, build };

  /// Does something and counts the CPU time that it takes: as a tick, as what ticks wait for, or as
  /// the building of the first scene.
  template <class Work>
  void measured(const std::string& what, Kind kind, Work&& work) {
    put(outcome_.doing, "step " + std::to_string(outcome_.steps) + ": " + what);
    set_alarm(limits_.hang);
    const double start = cpu_seconds();
    work();
    const double seconds = cpu_seconds() - start;
    set_alarm(0);
    outcome_.cpu += seconds;
    if (kind == Kind::build) {
      outcome_.longest_build = std::max(outcome_.longest_build, seconds);
    } else if (kind == Kind::tick) {
      outcome_.longest_tick = std::max(outcome_.longest_tick, seconds);
      outcome_.ticks_over += seconds > limits_.tick + limits_.grace;
    } else {
      outcome_.waits_over += seconds > limits_.wait;
      if (seconds <= outcome_.longest_wait) return;
      outcome_.longest_wait = seconds;
      put(outcome_.longest_wait_in, what.substr(0, what.find('{')));
    }
  }

  /// At a stop point of what runs.
  /// @returns whether to give it up
  bool attend() {
    if (in_tick_) do_within(stops_++);
    if (!in_tick_ || later_.empty()) limit_.signal().lower();
    return room_->gives_up();
  }

  /// Builds the scenes that are asked for, and does what comes by this stop point of a tick.
  void do_within(int stop) {
    build_beside();
    while (!later_.empty() && later_.front().within <= stop) {
      const Step step = std::move(later_.front());
      later_.pop_front();
      act(step);
    }
  }

  /// On a thread of its own, as in the server; but waited for, so that each run is the same.
  void build_beside() {
    for (auto& job : std::exchange(jobs_, {})) std::thread(std::move(job)).join();
  }

  void take(server::Inbound item, const std::string& what) {
    if (in_tick_) return room_->take_meanwhile(std::move(item));
    measured(what, Kind::wait, [&] {
      room_->take(std::move(item));
      room_->finish_turn();
    });
  }

  void follow(const Step& step) {
    if (step.within >= 0) {
      later_.push_back(step);
    } else if (step.kind == Step::Kind::ticks) {
      for (int k = 0; k < step.ticks && outcome_.cpu <= limits_.scene; ++k) tick();
    } else {
      act(step);
      finish_advance();
    }
  }

  void act(const Step& step) {
    switch (step.kind) {
      case Step::Kind::ticks:
        break;
      case Step::Kind::join:
        join(step.viewer);
        break;
      case Step::Kind::leave:
        leave(step.viewer);
        break;
      case Step::Kind::say:
        say(step.viewer, step.text);
        break;
    }
  }

  /// A viewer that comes again is another one to the room, as each connection is to the server.
  void join(proto::ViewerId viewer) {
    const proto::ViewerId known_as = viewer + kConnection * connections_++;
    here_[viewer] = known_as;
    take({known_as, 0, server::Join{}}, "join");
  }

  /// What it has not been answered yet, it need not be any more.
  void leave(proto::ViewerId viewer) {
    const proto::ViewerId known_as = id_of(viewer);
    here_.erase(viewer);
    std::erase_if(asked_, [&](const auto& asked) {
      return asked.first == known_as && !listener_.answers.contains(asked);
    });
    take({known_as, 0, server::Leave{}}, "leave");
  }

  /// What the room knows the script's viewer as; one that is not here has no id of the room's.
  proto::ViewerId id_of(proto::ViewerId viewer) const {
    const auto found = here_.find(viewer);
    return found == here_.end() ? viewer : found->second;
  }

  void tick() {
    if (room_->ticking()) {
      now_ += room_->tick_interval();
      one_tick("", [this] { room_->tick(); });
    }
    end_turn();
    finish_advance();
  }

  /// What was to come within a tick comes now if none passes, and so do scenes that are asked for.
  void end_turn() {
    if (!room_->ticking() && !room_->advancing()) do_within(std::numeric_limits<int>::max());
    measured("the end of a turn", Kind::wait, [this] { room_->finish_turn(); });
  }

  template <class Work>
  void one_tick(const std::string& of_what, Work&& work) {
    const std::uint64_t before = room_->world().tick();
    stops_ = 0;
    in_tick_ = true;
    if (!later_.empty() || !jobs_.empty()) limit_.signal().raise();
    measured("tick " + std::to_string(before + 1) + of_what, Kind::tick, work);
    in_tick_ = false;
    limit_.signal().lower();
    if (room_->world().tick() != before) note_tick();  // else it was given up
    do_within(std::numeric_limits<int>::max());        // what it had no stop point for
  }

  void note_tick() {
    ++outcome_.ticks;
    const TickReport& report = room_->world().report();
    if (report.divergence && !report.rested) ++outcome_.recoveries;
    if (!std::isfinite(report.energies.total())) {
      ++outcome_.not_finite_energy;
      listener_.problem("the energy is not finite");
    }
  }

  void say(proto::ViewerId viewer, const std::string& text) {
    const auto request = proto::parse_request(text);
    if (!request) return listener_.problem("not legal: " + request.error().message);
    ++outcome_.commands;
    const std::string name = proto::name_of(request->command);
    const proto::ViewerId known_as = id_of(viewer);
    server::Inbound item{known_as, ++number_, *request};
    // The session answers these, and the room hears of their number alone.
    const auto* view = std::get_if<proto::View>(&request->command);
    if (view && view->forces) listener_.forces = *view->forces;
    if (view || std::holds_alternative<proto::Ping>(request->command))
      item.what = server::Noted{view != nullptr, view ? view->forces : std::nullopt};
    else if (request->id)
      asked_.emplace_back(known_as, json::parse(text)["id"]);
    take(std::move(item), name + " " + text);
  }

  /// Runs an `advance` tick by tick; one that takes too long is ended as its viewer leaves.
  void finish_advance() {
    for (int turn = 0; room_->advancing(); ++turn) {
      if (turn == kPatience || outcome_.cpu > limits_.scene) {
        for (const auto& [viewer, known_as] : std::map(here_)) {
          leave(viewer);
          join(viewer);
        }
        if (room_->advancing()) listener_.problem("an advance goes on after its viewer has left");
        return;
      }
      one_tick(" of advance", [this] { room_->advance_until(now_); });
      end_turn();
    }
  }

  /// Lets so much time pass without ticks that all that waits for its turn has it.
  void settle() {
    for (int turn = 0; turn < kSettling; ++turn) {
      now_ += 0.1;
      do_within(std::numeric_limits<int>::max());
      end_turn();
      finish_advance();
    }
  }

  /// Whether what is promised is so: nothing that the guarantee covers crosses while it holds.
  void audit() {
    CrossingCounter<float> counter;
    const WorldCrossings crossings = counter.count(room_->world());
    const json state = ask("state");
    if (!state.is_object()) return listener_.problem("the state is not told");
    const json& guarantee = state["guarantee"];
    if (guarantee["state"] != "held") return;
    for (const json& covered : guarantee["covers"]) {
      const std::size_t count =
          covered == "cloth" ? crossings.cloths.all() : crossings.objects.all();
      if (count == 0) continue;
      ++outcome_.false_promises;
      listener_.problem("the guarantee is held and covers " + covered.get<std::string>() +
                        ", of which so many cross: " + std::to_string(count));
    }
  }

  json ask(const std::string& what) {
    listener_.last_answer = nullptr;
    const std::string text =
        R"({"op":"query","id":"audit )" + what + R"(","what":")" + what + "\"}";
    take({id_of(kAuditor), ++number_, *proto::parse_request(text)}, "query " + text);
    return listener_.last_answer.is_object() ? listener_.last_answer.value("data", json()) : json();
  }

  /// Each command with an id of a viewer that is here is answered once.
  void count_answers() {
    std::set<proto::ViewerId> here;
    for (const auto& [viewer, known_as] : here_) here.insert(known_as);
    for (const auto& [viewer, id] : asked_) {
      const auto found = listener_.answers.find({viewer, id});
      const int count = found == listener_.answers.end() ? 0 : found->second;
      if (count == 1 || !here.contains(viewer)) continue;
      listener_.problem("command " + id.dump() + " of viewer " + std::to_string(viewer) + " has " +
                        std::to_string(count) + " answers");
    }
    if (outcome_.recoveries > 0 && listener_.recoveries_told == 0)
      listener_.problem("no viewer was told of " + std::to_string(outcome_.recoveries) +
                        " blow-ups");
    if (outcome_.halts > 0 && listener_.halts_told == 0)
      listener_.problem("no viewer was told of " + std::to_string(outcome_.halts) + " halts");
  }

  /// Ticks that were given up stand in the log as commands; those that a reset or a load made
  /// worthless are no fault.
  void count_halts() {
    for (const server::LogEntry& entry : room_->log().entries()) {
      const auto* halt = std::get_if<proto::Halt>(&entry.command);
      if (!halt || halt->cause.find("replaces the state") != std::string::npos) continue;
      ++outcome_.halts;
      put(outcome_.halt, proto::encode_request({std::nullopt, entry.command}));
    }
  }

  const Script& script_;
  const server::SceneLibrary& library_;
  const Limits& limits_;
  Outcome& outcome_;
  Executor* executor_;
  Listener listener_;
  server::Metrics metrics_;
  server::WorkLimit limit_;
  server::LimitWatch watch_;
  std::unique_ptr<server::Room> room_;
  double now_ = 100;
  std::uint64_t looks_ = 0;
  std::uint32_t number_ = 0;
  std::map<proto::ViewerId, proto::ViewerId> here_;  // the script's viewers, as the room knows them
  proto::ViewerId connections_ = 1;                  // so far, and one
  std::vector<std::pair<proto::ViewerId, json>> asked_;
  std::deque<Step> later_;                   // within the coming tick
  std::vector<std::function<void()>> jobs_;  // that build scenes
  bool in_tick_ = false;
  int stops_ = 0;  // of the running tick, so far
};

}  // namespace

void run_script(const Script& script, const server::SceneLibrary& library, const Limits& limits,
                std::uint64_t most_steps, Outcome& outcome, Executor* executor) {
  Run(script, library, limits, outcome, executor).go(most_steps);
}

}  // namespace weft::fuzz
