#include "tests/bench/wire/recording.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>
#include <stdexcept>

#include "core/scenes/scene_parts.h"
#include "core/world/world.h"
#include "tests/support/sheets_of_triangles.h"

namespace weft::bench {
namespace {

constexpr int kWarmUp = 120;               // ticks
constexpr double kSize = 1.5, kTop = 2.2;  // of the cloth, and its upper edge [m]

WorldDef definition(const std::string& motion, int side) {
  WorldDef def;
  def.cloths[0] = hanging_cloth(side, side, kSize, kSize, kTop, 0);
  for (int k = 0; k < 9; ++k) def.pins.push_back({MaterialPoint{k / 8.0, 0}, 0.02, {}});
  def.environment.damping = 0.1;
  if (motion == "gusts") {
    def.environment.wind = Vec3d(0.2, 0, 0.9);
    def.environment.gust_speed = 1.0;
  } else {
    def.environment.wind = Vec3d(0, 0, 0.08);
    def.environment.gust_speed = 0.04;
    def.environment.damping = 2;
  }
  return def;
}

/// A cloth like that of `definition`, of random triangles.
ClothDef random_mesh(int side) {
  ClothDef sheet = test::triangle_sheet(test::Cut::irregular, kSize, kSize, kSize / (side - 1));
  sheet.fabric = ClothDef{}.fabric;
  for (Vec3d& p : sheet.mesh->mesh.positions) p += Vec3d(-kSize / 2, kTop, 0);
  return sheet;
}

/// Two triangles a cell, which as_mesh() cuts anew; the model's own have diagonals both ways.
void cut_cells(int side, Recording& recording) {
  const auto n = static_cast<std::uint32_t>(side);
  recording.triangles.clear();
  for (std::uint32_t i = 0; i + n < n * n; ++i) {
    if (i % n + 1 == n) continue;
    recording.triangles.insert(recording.triangles.end(),
                               {i, i + n, i + 1, i + 1, i + n, i + n + 1});
  }
}

Recording record(const WorldDef& def, const std::string& motion, int frames) {
  World<float> world(def, {});
  Recording recording;
  recording.motion = motion;
  const std::size_t count = world.state().x.size();
  const auto& triangles = world.model().triangles;
  recording.cloth = {
      0, static_cast<std::uint32_t>(count), 0, static_cast<std::uint32_t>(triangles.size()), 0, 0};
  for (const Triangle& triangle : triangles)
    for (const Index corner : triangle)
      recording.triangles.push_back(static_cast<std::uint32_t>(corner));
  double speeds = 0;
  for (int tick = 0; tick < kWarmUp + frames; ++tick) {
    if (world.step().divergence) throw std::runtime_error("the cloth diverged");
    if (tick < kWarmUp) continue;
    std::vector<float>& frame = recording.frames.emplace_back();
    for (const Vec3<float>& x : world.state().x) frame.insert(frame.end(), {x[0], x[1], x[2]});
    for (const Vec3<float>& v : world.state().v) speeds += static_cast<double>(v.norm());
  }
  recording.mean_speed = speeds / static_cast<double>(count) / frames;
  return recording;
}

}  // namespace

Recording record_motion(const std::string& motion, int side, int frames) {
  Recording recording = record(definition(motion, side), motion, frames);
  recording.mesh = "grid";
  cut_cells(side, recording);
  recording.cloth.rows = recording.cloth.columns = static_cast<std::uint32_t>(side);
  return recording;
}

Recording record_random_mesh(const std::string& motion, int side, int frames) {
  WorldDef def = definition(motion, side);
  def.cloths[0] = random_mesh(side);
  Recording recording = record(def, motion, frames);
  recording.mesh = "random";
  return recording;
}

Recording as_mesh(const Recording& grid) {
  std::mt19937 random(1);
  const std::uint32_t count = grid.cloth.vertices;
  std::vector<std::uint32_t> names(count);
  std::iota(names.begin(), names.end(), 0U);
  std::shuffle(names.begin(), names.end(), random);
  Recording mesh;
  mesh.motion = grid.motion;
  mesh.mesh = "mesh";
  mesh.mean_speed = grid.mean_speed;
  mesh.cloth = grid.cloth;
  mesh.cloth.rows = mesh.cloth.columns = 0;
  for (const std::vector<float>& frame : grid.frames) {
    std::vector<float>& out = mesh.frames.emplace_back(frame.size());
    for (std::size_t i = 0; i < count; ++i)
      std::copy_n(frame.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                  out.begin() + static_cast<std::ptrdiff_t>(3 * std::size_t{names[i]}));
  }
  for (std::size_t t = 0; t + 5 < grid.triangles.size(); t += 6) {
    const std::uint32_t a = names[grid.triangles[t]], c = names[grid.triangles[t + 1]],
                        b = names[grid.triangles[t + 2]], d = names[grid.triangles[t + 5]];
    if (random() % 2 == 0)
      mesh.triangles.insert(mesh.triangles.end(), {a, c, b, b, c, d});
    else
      mesh.triangles.insert(mesh.triangles.end(), {a, c, d, a, d, b});
  }
  return mesh;
}

}  // namespace weft::bench
