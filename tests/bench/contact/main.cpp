// Times each tick of the cases of contact, from states that a run of one version recorded.

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/diagnostics/crossings.h"
#include "tests/bench/contact/cases.h"
#include "tests/bench/contact/dealt_chunks.h"

namespace weft::bench {
namespace {

/// Ticks from a recorded state on that are not timed: what rests on each other finds its impulses.
constexpr int kLeadIn = 2;
constexpr double kTick = 1.0 / 60;

double cpu_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Cloth at one instant.
struct State {
  Vec3Array<float> x, v;
};

/// What the run of one version leaves to others: all that a case does not say itself.
struct Recording {
  std::vector<Index> held;     ///< by each hand
  std::vector<Vec3d> origins;  ///< where these were taken hold of [m]
  std::vector<State> states;   ///< at the beginning of each stretch, before its lead-in
};

int stretches(const ContactCase& c) {
  return c.stretch > 0 ? (c.ticks + c.stretch - 1) / c.stretch : 1;
}
int first_timed(const ContactCase& c, int stretch) {
  return c.before + stretch * c.stretch;
}
int first_tick(const ContactCase& c, int stretch) {
  return std::max(0, first_timed(c, stretch) - kLeadIn);
}

template <class T>
void put(std::ostream& out, const std::vector<T>& values) {
  const auto count = static_cast<std::uint64_t>(values.size());
  out.write(reinterpret_cast<const char*>(&count), sizeof count);
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(count * sizeof(T)));
}
template <class T>
void take(std::istream& in, std::vector<T>& values) {
  std::uint64_t count = 0;
  in.read(reinterpret_cast<char*>(&count), sizeof count);
  if (!in || count > (1u << 24)) throw std::runtime_error("this is no recording");
  values.resize(count);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
  if (!in) throw std::runtime_error("the recording ends too early");
}

void write(const Recording& recording, const std::string& path) {
  std::ofstream out(path, std::ios::binary);
  put(out, recording.held);
  put(out, recording.origins);
  for (const State& state : recording.states) {
    put(out, state.x);
    put(out, state.v);
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

Recording read(const ContactCase& c, const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path);
  Recording recording;
  take(in, recording.held);
  take(in, recording.origins);
  recording.states.resize(static_cast<std::size_t>(stretches(c)));
  for (State& state : recording.states) {
    take(in, state.x);
    take(in, state.v);
  }
  return recording;
}

/// The world of a case, tick by tick, with its hands.
class Run {
 public:
  /// @param threads  run the chunks of the steps; may be null
  Run(const ContactCase& c, int tick, Executor* threads = nullptr)
      : case_(c), world_(c.def, {.executor = threads}), tick_(tick) {}

  void put_into(const State& state) {
    world_.state().x = state.x;
    world_.state().v = state.v;
    world_.accept_state();
  }
  State state() const { return {world_.state().x, world_.state().v}; }

  /// Has all hands take hold, of what is farthest in their directions.
  void take_hold(Recording& recording) const {
    for (const CaseHand& hand : case_.hands) {
      const Vec3Array<float>& x = world_.state().x;
      const auto along = [&](const Vec3f& p) { return hand.direction.dot(p.cast<double>()); };
      const auto farthest = std::max_element(
          x.begin(), x.end(), [&](const Vec3f& a, const Vec3f& b) { return along(a) < along(b); });
      recording.held.push_back(static_cast<Index>(farthest - x.begin()));
      recording.origins.push_back(farthest->cast<double>());
    }
  }

  /// Moves the hands and steps. @return CPU milliseconds of the step
  double step(const Recording& recording) {
    for (std::size_t h = 0; tick_ >= case_.before && h < case_.hands.size(); ++h) {
      if (grabs_.size() == h) grabs_.push_back(world_.grab(grab_of(recording, h)));
      world_.move_grab(grabs_[h], target_of(recording, h));
    }
    const double start = cpu_milliseconds();
    world_.step();
    const double milliseconds = cpu_milliseconds() - start;
    ++tick_;
    return milliseconds;
  }

  std::size_t crossings(Bvh<double>& tree) const {
    const ClothModel<float>& model = world_.model();
    const Crossings found =
        count_self_crossings(world_.state().x, model.edges, model.triangles, tree);
    return found.proper + found.touching;
  }
  const World<float>& world() const { return world_; }
  int tick() const { return tick_; }

 private:
  Vec3d target_of(const Recording& recording, std::size_t h) const {
    return recording.origins[h] + case_.hands[h].path((tick_ + 1 - case_.before) * kTick);
  }
  GrabDef grab_of(const Recording& recording, std::size_t h) const {
    const std::vector<Triangle>& triangles = world_.model().triangles;
    GrabDef grab;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto corner = std::find(triangles[t].begin(), triangles[t].end(), recording.held[h]);
      if (corner == triangles[t].end()) continue;
      grab.triangle = static_cast<Index>(t);
      grab.barycentric = {0, 0, 0};
      grab.barycentric[static_cast<std::size_t>(corner - triangles[t].begin())] = 1;
      break;
    }
    grab.stiffness = case_.hands[h].stiffness;
    grab.max_force = case_.hands[h].max_force;
    grab.target = target_of(recording, h);
    return grab;
  }

  const ContactCase& case_;
  World<float> world_;
  int tick_;
  std::vector<GrabId> grabs_;
};

Recording record(const ContactCase& c) {
  Recording recording;
  Run run(c, 0);
  int stretch = 0;
  while (true) {
    if (run.tick() == c.before) run.take_hold(recording);
    if (run.tick() == first_tick(c, stretch)) {
      recording.states.push_back(run.state());
      if (++stretch == stretches(c) && run.tick() >= c.before) return recording;
    }
    if (stretch == stretches(c) && run.tick() >= c.before) return recording;
    run.step(recording);
  }
}

/// What the guard did and what crossed in a run.
struct Account {
  double wanted = 0, truncated = 0;  ///< motion [m]
  std::size_t collections = 0, renewals = 0, crossings = 0;
};

void add_counts(const World<float>& world, Account& account) {
  if (!world.guard()) return;
  const GuardCounts& counts = world.guard()->counts();
  account.wanted += counts.wanted;
  account.truncated += counts.truncated;
  account.collections += counts.collections;
  account.renewals += counts.renewals;
}

/// Prints the CPU milliseconds of each tick as one line of JSON.
/// @param count  count crossings after each tick too
void time_case(const ContactCase& c, const Recording& recording, bool count) {
  Account account;
  Bvh<double> tree;
  std::cout << "{\"case\": \"" << c.name << "\", \"milliseconds\": [";
  for (int stretch = 0; stretch < stretches(c); ++stretch) {
    Run run(c, first_tick(c, stretch));
    if (run.tick() > 0) run.put_into(recording.states[static_cast<std::size_t>(stretch)]);
    while (run.tick() < first_timed(c, stretch)) run.step(recording);
    const int end = c.stretch > 0 ? std::min(first_timed(c, stretch + 1), c.before + c.ticks)
                                  : c.before + c.ticks;
    while (run.tick() < end) {
      std::cout << (run.tick() == c.before ? "" : ", ");
      std::cout << run.step(recording);
      if (count) account.crossings += run.crossings(tree);
    }
    add_counts(run.world(), account);
  }
  std::cout << "], \"wanted\": " << account.wanted << ", \"truncated\": " << account.truncated
            << ", \"collections\": " << account.collections
            << ", \"renewals\": " << account.renewals << ", \"crossings\": ";
  if (count)
    std::cout << account.crossings << "}" << std::endl;
  else
    std::cout << "null}" << std::endl;
}

/// Prints of each tick the wall milliseconds and those of the critical path of two threads.
void time_path(const ContactCase& c, const Recording& recording) {
  DealtChunks dealt;
  std::vector<double> whole, path;
  for (int stretch = 0; stretch < stretches(c); ++stretch) {
    Run run(c, first_tick(c, stretch), &dealt);
    if (run.tick() > 0) run.put_into(recording.states[static_cast<std::size_t>(stretch)]);
    while (run.tick() < first_timed(c, stretch)) run.step(recording);
    const int end = c.stretch > 0 ? std::min(first_timed(c, stretch + 1), c.before + c.ticks)
                                  : c.before + c.ticks;
    while (run.tick() < end) {
      dealt.take_saved();
      const double start = wall_milliseconds();
      run.step(recording);
      whole.push_back(wall_milliseconds() - start);
      path.push_back(whole.back() - dealt.take_saved());
    }
  }
  const auto print = [](const char* name, const std::vector<double>& numbers) {
    std::cout << '"' << name << "\": [";
    for (std::size_t k = 0; k < numbers.size(); ++k) std::cout << (k > 0 ? ", " : "") << numbers[k];
    std::cout << ']';
  };
  std::cout << "{\"case\": \"" << c.name << "\", ";
  print("milliseconds", whole);
  std::cout << ", ";
  print("path", path);
  std::cout << "}" << std::endl;
}

int run(const std::vector<std::string>& words) {
  const std::string verb = words.empty() ? "" : words[0];
  if (verb == "list") {
    for (const ContactCase& c : contact_cases()) std::cout << c.name << '\t' << c.how << '\n';
    return 0;
  }
  const std::vector<std::string> verbs = {"record", "time", "count", "path"};
  if (words.size() < 3 || std::find(verbs.begin(), verbs.end(), verb) == verbs.end())
    throw std::runtime_error("usage: list | record CASE FILE | time|count|path CASE FILE");
  for (const ContactCase& c : contact_cases()) {
    if (c.name != words[1]) continue;
    if (verb == "record")
      write(record(c), words[2]);
    else if (verb == "path")
      time_path(c, read(c, words[2]));
    else
      time_case(c, read(c, words[2]), verb == "count");
    return 0;
  }
  throw std::runtime_error("there is no case " + words[1]);
}

}  // namespace
}  // namespace weft::bench

int main(int argc, char** argv) {
  try {
    return weft::bench::run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    std::cerr << "weft_contact_bench: " << error.what() << std::endl;
    return 1;
  }
}
