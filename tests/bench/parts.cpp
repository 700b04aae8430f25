#include "tests/bench/parts.h"

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "core/forces/air/air.h"
#include "core/scenes/scenes.h"
#include "core/world/world.h"
#include "tests/bench/measures.h"

namespace weft::bench {
namespace {

struct Variant {
  const char* off;
  WorldDef def;
  std::vector<double> seconds{};
  Snapshot end{};
  std::uint64_t hash = 0;
};

/// The scene as it is, and without each part that it has.
std::vector<Variant> variants(const WorldDef& def) {
  std::vector<Variant> all = {{"nothing", def}};
  const auto without = [&](const char* part, bool has, auto&& change) {
    if (!has) return;
    all.push_back({part, def});
    change(all.back().def);
  };
  const auto any = [&](auto&& test) {
    return std::any_of(def.cloths.begin(), def.cloths.end(), test);
  };
  without("wind", !is_calm(def.environment), [](WorldDef& d) {
    d.environment.wind.setZero();
    d.environment.gust_speed = 0;
    d.environment.still_air = false;
    d.environment.fans.clear();
  });
  without("bending", any([](const ClothDef& c) {
            return c.fabric.bending_warp > 0 || c.fabric.bending_weft > 0 || c.skip_stiffness > 0;
          }),
          [](WorldDef& d) {
            for (ClothDef& c : d.cloths)
              c.fabric.bending_warp = c.fabric.bending_weft = c.skip_stiffness = 0;
          });
  without("friction",
          !def.colliders.empty() && any([](const ClothDef& c) { return c.fabric.friction > 0; }),
          [](WorldDef& d) {
            for (ClothDef& c : d.cloths) c.fabric.friction = 0;
          });
  without("contact with objects", !def.colliders.empty(), [](WorldDef& d) { d.colliders.clear(); });
  without("self-contact", has_guard(def) || def.contact.seed.has_self_contact(),
          [](WorldDef& d) { d.contact.seed.self = SelfContact::none; });
  return all;
}

void run(Variant& variant, int ticks) {
  World<float> world(variant.def);
  const double start = cpu_seconds();
  for (int k = 0; k < ticks; ++k) world.step();
  variant.seconds.push_back(cpu_seconds() - start);
  variant.end = snapshot(world.state());
  variant.hash = world.hash();
}

/// Hard cases are not for everyday, and the seed's experiments take a minute.
bool left_out(const std::string& name, bool quick) {
  return name.rfind("hard-", 0) == 0 || (quick && name.rfind("seed-", 0) == 0);
}

/// CPU seconds of a scene's second tick.
double cost_of_tick(const WorldDef& def) {
  World<float> world(def);
  world.step();
  const double start = cpu_seconds();
  world.step();
  return cpu_seconds() - start;
}

}  // namespace

std::vector<PartFigure> measure_parts(bool quick, const std::string& mesh_directory) {
  const int runs = quick ? 1 : 5;
  std::vector<PartFigure> figures;
  for (const SceneInfo& info : scenes()) {
    if (left_out(info.name, quick)) continue;
    const std::filesystem::path mesh = mesh_directory + "/" + info.installed + ".ply";
    if (!info.installed.empty() && !std::filesystem::exists(mesh)) continue;
    const WorldDef def = make_scene(info.name, mesh_directory);
    std::vector<Variant> all = variants(def);
    const double tick = cost_of_tick(def), budget = quick ? 0.05 : 0.15;
    const int ticks = std::clamp(static_cast<int>(budget / tick), 6, 60);
    for (int k = 0; k < runs; ++k) {
      for (Variant& variant : all) run(variant, ticks);
    }
    for (const Variant& variant : all) {
      PartFigure f;
      f.scene = info.name;
      f.solver = solver_name(def);
      f.off = variant.off;
      f.ticks = ticks;
      f.cpu_per_second = median(variant.seconds) * def.tick_rate / ticks;
      f.moved = rms_distance(variant.end, all.front().end);
      f.same_bits = variant.hash == all.front().hash;
      f.runs = runs;
      figures.push_back(f);
    }
  }
  return figures;
}

}  // namespace weft::bench
