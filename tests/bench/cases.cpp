#include "tests/bench/cases.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/cloth/fabric_presets.h"

namespace weft::bench {
namespace {

WorldDef quiet_world(int rows, int columns, const FabricDef& fabric) {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.rows = rows;
  cloth.columns = columns;
  cloth.fabric = fabric;
  cloth.u = Vec3d::UnitX();
  cloth.v = Vec3d::UnitZ();
  def.environment.air_density = 0;
  def.environment.drag = 5;
  // References are for springs and objects alone.
  def.contact.seed.self = SelfContact::none;
  return def;
}

void pin_rows(WorldDef& def, int first, int count) {
  const int columns = def.cloths[0].columns;
  for (int i = first * columns; i < (first + count) * columns; ++i) def.pins.push_back({i, 0, {}});
}

WorldDef swing(int n, const FabricDef& fabric) {
  WorldDef def = quiet_world(n, n, fabric);
  pin_rows(def, 0, 1);
  return def;
}

WorldDef static_rest(int n, const FabricDef& fabric) {
  WorldDef def = swing(n, fabric);
  pin_rows(def, n - 1, 1);
  def.environment.drag = 10;
  return def;
}

WorldDef cantilever(int n, const FabricDef& fabric) {
  WorldDef def = quiet_world(n, n / 4, fabric);
  def.cloths[0].height = 0.12;
  def.cloths[0].width = 0.03;
  pin_rows(def, 0, 2);
  return def;
}

WorldDef hanging_strip(int n, const FabricDef& fabric) {
  WorldDef def = quiet_world(n, n / 8, fabric);
  def.cloths[0].v = -Vec3d::UnitY();
  def.cloths[0].width = 0.12;
  pin_rows(def, 0, 1);
  return def;
}

WorldDef flag(int n, const FabricDef& fabric) {
  WorldDef def = quiet_world(n, n, fabric);
  def.cloths[0].u = Vec3d::UnitY();
  def.cloths[0].v = Vec3d::UnitX();
  pin_rows(def, 0, 1);
  def.environment.drag = 0;
  def.environment.air_density = 1.225;
  def.environment.wind = Vec3d(6, 0, 0.8);
  return def;
}

WorldDef drape(int n, const FabricDef& fabric) {
  WorldDef def = quiet_world(n, n, fabric);
  def.cloths[0].origin = Vec3d(-0.5, 0.62, -0.5);
  def.colliders = {{"sphere", SphereDef{Vec3d(0, 0.3, 0), 0.3}}};
  def.environment.drag = 0.5;
  return def;
}

FabricDef test_cloth(double structural) {
  FabricDef fabric;
  fabric.areal_density = 0.2;
  fabric.shear = 0.1 * structural;
  fabric.stretch_warp = fabric.stretch_weft = structural + fabric.shear;
  fabric.bending_warp = fabric.bending_weft = 1e-5;
  return fabric;
}

}  // namespace

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> scenes = {
      {"swing", "1 m x 1 m, held by one edge, let go when level", 30, 5, Compared::all_the_way,
       true, 4, 120, swing},
      {"static-rest", "1 m x 1 m between two opposite edges, sags and comes to rest", 120, 120,
       Compared::at_the_end, true, 2.5, 30, static_rest},
      {"cantilever", "a strip of 12 cm x 3 cm, clamped at one end, let go when level", 30, 5,
       Compared::all_the_way, true, 2.5, 30, cantilever},
      {"hanging-strip", "1 m x 12 cm, upright, let go when not stretched yet", 60, 5,
       Compared::all_the_way, true, 2.5, 30, hanging_strip},
      {"flag", "1 m x 1 m, held by one edge, in a wind of 6 m/s", 48, 3, Compared::all_the_way,
       false, 2, 10, flag},
      {"drape", "1 m x 1 m, falls on a sphere of 0.3 m radius", 48, 3, Compared::all_the_way, false,
       2, 10, drape}};
  return scenes;
}

double run_budget(const BenchScene& scene, int n) {
  return n > 128 ? 2 * scene.run_budget : scene.run_budget;
}

const std::vector<BenchFabric>& bench_fabrics() {
  static const std::vector<BenchFabric> fabrics = {
      {"soft", test_cloth(196)}, {"stiff", test_cloth(1962)}, {"cotton", make_fabric("cotton")}};
  return fabrics;
}

WorldDef without_dashpots(WorldDef def) {
  for (ClothDef& cloth : def.cloths) cloth.fabric.damping_ratio = 0;
  return def;
}

std::vector<Setting> settings(bool quick) {
  std::vector<Setting> all;
  const std::pair<const char*, double> factors[] = {
      {"x1", 1}, {"x1.25", 1.25}, {"x1.5", 1.5}, {"x2", 2}, {"x3", 3}};
  for (const auto& [name, factor] : factors) all.push_back({"verlet", name, factor, 1, 1, 1});
  all.push_back({"verlet", "x1 without dashpots", 1, 0, 1, 1});
  all.push_back({"verlet", "x1 two damping sweeps", 1, 2, 1, 1});
  const auto relaxing = [&](const char* solver, int substeps, int sweeps) {
    all.push_back(
        {solver, std::to_string(substeps) + "x" + std::to_string(sweeps), 1, 1, substeps, sweeps});
  };
  for (const int substeps : {4, 8, 12, 16, 24, 32, 64, 96, 128, 256}) relaxing("xpbd", substeps, 1);
  relaxing("xpbd", 16, 4);
  relaxing("xpbd", 4, 16);
  for (const int sweeps : {5, 10, 20, 50, 200}) relaxing("relaxation", 1, sweeps);
  relaxing("relaxation", 4, 10);
  relaxing("relaxation", 8, 5);
  relaxing("relaxation", 8, 20);
  if (!quick) return all;
  std::vector<Setting> some;
  std::map<std::string, int> seen;
  for (const Setting& setting : all) {
    if (seen[setting.solver]++ % 2 == 0) some.push_back(setting);
  }
  return some;
}

WorldDef with_setting(WorldDef def, const Setting& setting, int stable_substeps) {
  if (setting.solver == "verlet") {
    if (setting.damping_sweeps == 0) {
      def = without_dashpots(def);
      stable_substeps = 1;  // fewer than with dashpots; it takes its own count
    }
    def.solver.kind = SolverKind::verlet;
    def.solver.min_substeps = static_cast<int>(std::ceil(setting.factor * stable_substeps));
    def.solver.damping_sweeps = std::max(1, setting.damping_sweeps);
    return def;
  }
  def = without_dashpots(def);
  def.solver.kind = SolverKind::relaxation;
  def.relaxation.substeps = setting.substeps;
  def.relaxation.sweeps = setting.sweeps;
  def.relaxation.damping = 0;
  def.relaxation.compliance = setting.solver == "xpbd" ? 1 : 0;
  return def;
}

}  // namespace weft::bench
