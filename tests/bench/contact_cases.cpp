#include "tests/bench/contact_cases.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

#include "core/diagnostics/crossings.h"
#include "core/scenes/dress_form.h"
#include "server/thread_pool.h"
#include "tests/bench/contact_states.h"
#include "tests/bench/measures.h"

namespace weft::bench {
namespace {

/// A tick of 1/60 s [ms].
constexpr double kRealTime = 1000.0 / 60;
constexpr int kTicksASecond = 60;

struct Extent {
  int n = 64, runs = 5;
  int drop = 5 * kTicksASecond, rest = kTicksASecond / 2, hand = kTicksASecond;
};

double milliseconds_of_tick(World<float>& world) {
  const double start = cpu_seconds();
  world.step();
  return 1e3 * (cpu_seconds() - start);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// As a viewer waits for it, however many cores work.
double wall_milliseconds_of_tick(World<float>& world) {
  const double start = wall_seconds();
  world.step();
  return 1e3 * (wall_seconds() - start);
}

double mean(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += values[k];
  return sum / static_cast<double>(to - from);
}

double percentile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Of each tick the median of all runs.
std::vector<double> medians(const std::vector<std::vector<double>>& runs) {
  std::vector<double> result;
  for (std::size_t tick = 0; tick < runs.front().size(); ++tick) {
    std::vector<double> same;
    same.reserve(runs.size());
    for (const std::vector<double>& run : runs) same.push_back(run[tick]);
    result.push_back(median(same));
  }
  return result;
}

/// Speed that 99 % of the particles do not reach [mm/s].
double fastest_but_a_hundredth(const World<float>& world) {
  std::vector<double> speed;
  for (const Vec3f& v : world.state().v) speed.push_back(1e3 * static_cast<double>(v.norm()));
  return percentile(speed, 0.99);
}

/// Counts what passes through the cloth itself, exactly, beside the timed ticks.
class Counter {
 public:
  void look(const World<float>& world) {
    const ClothModel<float>& model = world.model();
    const Crossings found =
        count_self_crossings(world.state().x, model.edges, model.triangles, tree_);
    total_ += static_cast<double>(found.proper + found.touching);
  }
  double total() const { return total_; }

 private:
  Bvh<double> tree_;
  double total_ = 0;
};

/// Hand that takes hold at a particle.
GrabDef hold(const World<float>& world, std::size_t particle) {
  const std::vector<Triangle>& triangles = world.model().triangles;
  GrabDef grab;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto corner = std::find(triangles[t].begin(), triangles[t].end(), Index(particle));
    if (corner == triangles[t].end()) continue;
    grab.triangle = static_cast<Index>(t);
    grab.barycentric = {0, 0, 0};
    grab.barycentric[static_cast<std::size_t>(corner - triangles[t].begin())] = 1;
    break;
  }
  grab.target = world.state().x[particle].cast<double>();
  return grab;
}

/// The particle farthest along an axis.
std::size_t farthest(const World<float>& world, int axis) {
  const Vec3Array<float>& x = world.state().x;
  return static_cast<std::size_t>(
      std::max_element(x.begin(), x.end(),
                       [&](const Vec3f& a, const Vec3f& b) { return a[axis] < b[axis]; }) -
      x.begin());
}

class Cases {
 public:
  explicit Cases(const Extent& extent) : extent_(extent) {}

  /// A sheet that falls upright, crumples, comes to rest, and is touched there.
  /// @returns where it came to rest
  ContactState drop(const char* name, double thickness) {
    scene_ = name;
    std::cerr << "bench: contact, " << name << std::endl;
    ContactState pile{name, "", falling_sheet(extent_.n, thickness), {}, {}};
    std::vector<std::vector<double>> runs, walls;
    double fastest = 0, touched = 0;
    Counter counter;
    for (int k = 0; k < extent_.runs; ++k) {
      World<float> world(pile.def);
      runs.emplace_back();
      for (int tick = 0; tick < extent_.drop + extent_.rest; ++tick) {
        runs.back().push_back(milliseconds_of_tick(world));
        if (k > 0) continue;  // each run has the same bits
        counter.look(world);
        if (tick + 1 == extent_.drop) {
          pile.x = world.state().x;
          pile.v = world.state().v;
        }
        if (tick >= extent_.drop) fastest = std::max(fastest, fastest_but_a_hundredth(world));
      }
      if (k == 0) touched = touch(world, counter);
      World<float> on_two(pile.def, {&two_threads_, nullptr});
      walls.emplace_back();
      for (int tick = 0; tick < extent_.drop + extent_.rest; ++tick)
        walls.back().push_back(wall_milliseconds_of_tick(on_two));
    }
    const std::vector<double> ms = medians(runs), wall = medians(walls);
    const auto end = static_cast<std::size_t>(extent_.drop), second = end / 5;
    runs_ = extent_.runs;
    add("a tick in the first second", "ms", mean(ms, 0, second));
    add("a tick in the second second", "ms", mean(ms, second, 2 * second));
    add("a tick from 2 to 5 s", "ms", mean(ms, 2 * second, end));
    add("a tick from 0 to 5 s", "ms", mean(ms, 0, end), Bar::at_most, kRealTime);
    add("a tick at rest, after 5 s", "ms", mean(ms, end, ms.size()), Bar::at_most, kRealTime / 2);
    add("the same from 0 to 5 s, wall on two threads", "ms", mean(wall, 0, end), Bar::at_most,
        kRealTime);
    add("the same at rest, wall on two threads", "ms", mean(wall, end, wall.size()), Bar::at_most,
        kRealTime / 2);
    runs_ = 1;
    add("p99 speed, the fastest tick of the half second after 5 s", "mm/s", fastest, Bar::at_most,
        2);
    add("way of its top in 1 s under a hand of 0.1 N", "mm", touched, Bar::at_least, 2);
    add("crossings, at each tick, the touch included", "", counter.total(), Bar::at_most, 0);
    return pile;
  }

  /// A hand takes the rim of a pile and goes to and fro through its middle at 2 m/s.
  void pull_through(const ContactState& pile) {
    scene_ = pile.name;
    std::cerr << "bench: contact, a hand through " << pile.name << std::endl;
    constexpr double kSpeed = 2, kLeg = 0.5;  // [m/s], [m]
    std::vector<std::vector<double>> runs, walls;
    Counter counter;
    double longest_lag = 0;
    for (int k = 0; k < 2 * extent_.runs; ++k) {  // in turn on one thread and on two
      const bool alone = k % 2 == 0;
      World<float> world(pile.def, {alone ? nullptr : &two_threads_, nullptr});
      take_state(pile, world);
      for (int tick = 0; tick < 4; ++tick) world.step();
      const std::size_t held = farthest(world, 0);
      GrabDef grab = hold(world, held);
      grab.stiffness = 1000;
      const Vec3d from = grab.target;
      const GrabId hand = world.grab(grab);
      std::vector<double>& times = (alone ? runs : walls).emplace_back();
      for (int tick = 1; tick <= extent_.hand; ++tick) {
        const double distance = std::fmod(kSpeed * tick / kTicksASecond, 2 * kLeg);
        const double left = distance < kLeg ? distance : 2 * kLeg - distance;
        const Vec3d to = from - Vec3d(left, 0, 0);
        world.move_grab(hand, to);
        times.push_back(alone ? milliseconds_of_tick(world) : wall_milliseconds_of_tick(world));
        if (k > 0) continue;
        counter.look(world);
        const double lag = (world.state().x[held].cast<double>() - to).norm();
        longest_lag = std::max(longest_lag, 1e3 * lag);
      }
    }
    const std::vector<double> ms = medians(runs);
    runs_ = extent_.runs;
    add("a hand at 2 m/s through it, mean", "ms", mean(ms, 0, ms.size()), Bar::at_most, 25);
    add("a hand at 2 m/s through it, p95", "ms", percentile(ms, 0.95), Bar::at_most, 25);
    const std::vector<double> wall = medians(walls);
    add("the same mean, wall on two threads", "ms", mean(wall, 0, wall.size()), Bar::at_most, 25);
    runs_ = 1;
    add("the cloth lags behind the hand by at most", "mm", longest_lag);
    add("crossings under the hand, at each tick", "", counter.total(), Bar::at_most, 0);
  }

  /// A sheet that has come to rest on a dressmaker's form; what the contact takes of a tick.
  void lie_on_form() {
    scene_ = "on a model of 1,418 faces";
    std::cerr << "bench: contact, " << scene_ << std::endl;
    WorldDef def = falling_sheet(extent_.n, 0.25);
    def.cloths[0].origin = Vec3d(-0.5, 1.56, -0.5);
    def.cloths[0].v = Vec3d::UnitZ();
    def.colliders.push_back({"form", MeshDef{make_dress_form()}});
    World<float> world(def, {nullptr, cpu_seconds});
    Counter counter;
    for (int tick = 0; tick < extent_.drop; ++tick) {
      world.step();
      counter.look(world);
    }
    std::vector<double> contact, all;
    double fastest = 0;
    for (int k = 0; k < extent_.runs; ++k) {
      double in_contact = 0, in_all = 0;
      for (int tick = 0; tick < extent_.rest; ++tick) {
        in_all += milliseconds_of_tick(world);
        const Profile& profile = world.report().profile;
        for (const Stage stage : {Stage::broad_phase, Stage::pairs, Stage::narrow_phase,
                                  Stage::regions, Stage::contact})
          in_contact += 1e3 * profile[stage].seconds;
        counter.look(world);
        fastest = std::max(fastest, fastest_but_a_hundredth(world));
      }
      contact.push_back(in_contact / extent_.rest);
      all.push_back(in_all / extent_.rest);
    }
    runs_ = extent_.runs;
    add("contact of a tick at rest", "ms", median(contact), Bar::at_most, 4);
    add("the whole tick", "ms", median(all));
    runs_ = 1;
    add("p99 speed, the fastest tick after 5 s", "mm/s", fastest, Bar::at_most, 2);
    add("crossings of the cloth with itself, at each tick", "", counter.total(), Bar::at_most, 0);
  }

  /// Flat hanging cloth with and without contact with itself, in turn.
  void hang() {
    scene_ = "hanging flat";
    std::cerr << "bench: contact, " << scene_ << std::endl;
    World<float> with(hanging_sheet(extent_.n, true)), without(hanging_sheet(extent_.n, false));
    const auto ratio = [&](int ticks) {
      double one = 0, other = 0;
      for (int tick = 0; tick < ticks; ++tick) {
        one += milliseconds_of_tick(with);
        other += milliseconds_of_tick(without);
      }
      return one / other;
    };
    runs_ = 1;
    add("with over without contact with itself, in its first 2 s", "", ratio(extent_.drop * 2 / 5));
    for (int tick = 0; tick < extent_.drop * 3 / 5; ++tick) ratio(1);
    std::vector<double> ratios, ms;
    for (int k = 0; k < extent_.runs; ++k) ratios.push_back(ratio(extent_.rest));
    add("same bits with and without it", "", with.hash() == without.hash() ? 1 : 0, Bar::at_least,
        1);
    for (int tick = 0; tick < extent_.rest; ++tick) ms.push_back(milliseconds_of_tick(without));
    runs_ = extent_.runs;
    add("with over without contact with itself, from 5 s on", "", median(ratios), Bar::at_most,
        1.25);
    add("a tick without it", "ms", median(ms));
  }

  std::vector<CaseFigure> figures;

 private:
  /// Pulls the top of the pile with a hand of 0.1 N for a second. @returns its displacement [mm]
  double touch(World<float>& world, Counter& counter) const {
    const std::size_t top = farthest(world, 1);
    const Vec3f before = world.state().x[top];
    GrabDef grab = hold(world, top);
    grab.max_force = 0.1;
    grab.target += Vec3d(0, 0.05, 0);
    world.grab(grab);
    for (int tick = 0; tick < kTicksASecond; ++tick) {
      world.step();
      counter.look(world);
    }
    return 1e3 * static_cast<double>((world.state().x[top] - before).norm());
  }

  void add(const char* name, const char* unit, double value, Bar kind = Bar::none, double bar = 0) {
    figures.push_back({scene_, name, unit, value, kind, bar, runs_});
  }

  Extent extent_;
  server::ThreadPool two_threads_{2};
  std::string scene_;
  int runs_ = 1;
};

}  // namespace

std::vector<CaseFigure> measure_contact_cases(bool quick) {
  Extent extent;
  if (quick) extent = {24, 1, kTicksASecond, 6, 12};
  Cases cases(extent);
  const ContactState quarter = cases.drop("pile, thickness a quarter of the edge length", 0.25);
  cases.pull_through(quarter);
  const ContactState half = cases.drop("pile, thickness a half of the edge length", 0.5);
  cases.pull_through(half);
  cases.lie_on_form();
  cases.hang();
  return cases.figures;
}

}  // namespace weft::bench
