#include "tests/bench/cases.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/cloth/fabric_presets.h"
#include "core/world/world.h"

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
  def.environment.damping = 0.2;  // of the built-in scenes 0 to 0.5
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

WorldDef swing_free(int n, const FabricDef& fabric) {
  WorldDef def = swing(n, fabric);
  def.environment.damping = 0;
  return def;
}

WorldDef static_rest(int n, const FabricDef& fabric) {
  WorldDef def = swing(n, fabric);
  pin_rows(def, n - 1, 1);
  def.environment.damping = 10;
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
  def.environment.damping = 0;
  def.environment.air_density = 1.225;
  def.environment.wind = Vec3d(6, 0, 0.8);
  return def;
}

WorldDef drape(int n, const FabricDef& fabric) {
  WorldDef def = quiet_world(n, n, fabric);
  // Touches within two ticks: a stiff cloth is compared for a few ticks only, and would fall
  // freely. At rest on the sphere a micrometre would decide who is carried.
  const double radius = 0.3, fall = 5e-3;
  def.cloths[0].origin = Vec3d(-0.5, 2 * radius + fabric.thickness + fall, -0.5);
  def.colliders = {{"sphere", SphereDef{Vec3d(0, radius, 0), radius}}};
  def.environment.damping = 0.5;
  return def;
}

WorldDef drape_free(int n, const FabricDef& fabric) {
  WorldDef def = drape(n, fabric);
  def.environment.damping = 0;
  return def;
}

/// The preset without dashpots of its own. They act between ticks, in every solver alike, so that
/// no substeps change what they err by; and motion that nothing damps is the harder case.
FabricDef undamped_cotton() {
  FabricDef fabric = make_fabric("cotton");
  fabric.bending_damping = 0;
  return fabric;
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
      {"swing", "1 m x 1 m, held by one edge, let go when level", 90, 5, Instants::all_the_way,
       true, 9, 120, swing},
      {"swing-free", "the same without drag", 90, 5, Instants::all_the_way, true, 9, 120,
       swing_free},
      {"static-rest", "1 m x 1 m between two opposite edges, sags and comes to rest", 120, 120,
       Instants::at_the_end, true, 4, 30, static_rest},
      {"cantilever", "a strip of 12 cm x 3 cm, clamped at one end, let go when level", 30, 5,
       Instants::all_the_way, true, 3.5, 30, cantilever},
      {"hanging-strip", "1 m x 12 cm, upright, let go when not stretched yet", 60, 5,
       Instants::all_the_way, true, 2.5, 30, hanging_strip},
      {"flag", "1 m x 1 m, held by one edge, in a wind of 6 m/s", 48, 3, Instants::all_the_way,
       false, 2, 10, flag},
      {"drape", "1 m x 1 m, falls 5 mm on a sphere of 0.3 m radius", 90, 3, Instants::all_the_way,
       false, 4, 20, drape},
      {"drape-free", "the same without drag", 90, 3, Instants::all_the_way, false, 4, 20,
       drape_free}};
  return scenes;
}

double run_budget(const BenchScene& scene, int n) {
  return n > 128 ? 2 * scene.run_budget : scene.run_budget;
}

const std::vector<BenchFabric>& bench_fabrics() {
  static const std::vector<BenchFabric> fabrics = {
      {"soft", test_cloth(196)}, {"stiff", test_cloth(1962)}, {"cotton", undamped_cotton()}};
  return fabrics;
}

WorldDef without_dashpots(WorldDef def) {
  for (ClothDef& cloth : def.cloths) cloth.fabric.damping_ratio = 0;
  return def;
}

namespace {

Setting relaxing(const char* solver, int substeps, int sweeps) {
  return {solver, std::to_string(substeps) + "x" + std::to_string(sweeps), 1, 1, substeps, sweeps};
}

/// Those of a list that are not below the fewest substeps, from the fewest on, and where these are
/// few, multiples of the fewest.
std::vector<int> substeps_from(int fewest, const std::vector<int>& wanted) {
  std::set<int> all;
  for (const int substeps : wanted) {
    if (substeps >= fewest) all.insert(substeps);
  }
  if (all.size() < wanted.size()) all.insert(fewest);
  for (const double factor : {1.25, 1.5, 2.0, 3.0, 4.0, 6.0}) {
    if (all.size() < wanted.size()) all.insert(static_cast<int>(std::ceil(factor * fewest)));
  }
  return {all.begin(), all.end()};
}

/// Even numbers of sweeps, which XPBD would raise an odd one to.
std::vector<Setting> settings_of_xpbd(int fewest) {
  std::vector<Setting> all;
  for (const int substeps : substeps_from(fewest, {4, 8, 12, 16, 24, 32, 64, 96, 128, 256}))
    all.push_back(relaxing("xpbd", substeps, 2));
  all.push_back(relaxing("xpbd", std::max(16, fewest), 4));
  all.push_back(relaxing("xpbd", std::max(4, fewest), 16));
  return all;
}

/// Many sweeps over few substeps, as the seed has it; where bending asks for many substeps, fewer
/// sweeps.
std::vector<Setting> settings_of_relaxation(int fewest) {
  static constexpr std::pair<int, int> kWanted[] = {{1, 5},   {1, 10}, {1, 20}, {1, 50},
                                                    {1, 200}, {4, 10}, {8, 5},  {8, 20},
                                                    {1, 1},   {1, 2},  {1, 3}};
  static constexpr std::size_t kEnough = 8;
  std::vector<Setting> all;
  std::set<std::pair<int, int>> seen;
  for (const auto& [substeps, sweeps] : kWanted) {
    const int taken = std::max(substeps, fewest);
    if (all.size() < kEnough && seen.emplace(taken, sweeps).second)
      all.push_back(relaxing("relaxation", taken, sweeps));
  }
  return all;
}

/// Substeps of BDF2 with two Newton iterations each, and of one with three. Where there is contact
/// those below kFewestInContact run with so many.
std::vector<Setting> settings_of_implicit() {
  std::vector<Setting> all;
  for (const int substeps : {1, 2, 3, 4, 6, 8, 12, 16})
    all.push_back(relaxing("implicit", substeps, 2));
  all.push_back(relaxing("implicit", 1, 3));
  return all;
}

}  // namespace

std::vector<Setting> settings(bool quick, int fewest) {
  std::vector<Setting> all;
  const std::pair<const char*, double> factors[] = {
      {"x1", 1}, {"x1.25", 1.25}, {"x1.5", 1.5}, {"x2", 2}, {"x3", 3}};
  for (const auto& [name, factor] : factors) all.push_back({"verlet", name, factor, 1, 1, 1});
  all.push_back({"verlet", "x1 without dashpots", 1, 0, 1, 1});
  all.push_back({"verlet", "x1 two damping sweeps", 1, 2, 1, 1});
  for (const Setting& setting : settings_of_implicit()) all.push_back(setting);
  for (const Setting& setting : settings_of_xpbd(fewest)) all.push_back(setting);
  for (const Setting& setting : settings_of_relaxation(fewest)) all.push_back(setting);
  if (!quick) return all;
  std::vector<Setting> some;
  std::map<std::string, int> seen;
  for (const Setting& setting : all) {
    if (seen[setting.solver]++ % 2 == 0) some.push_back(setting);
  }
  return some;
}

int fewest_relaxing_substeps(const WorldDef& def) {
  World<float> probe(with_setting(def, relaxing("xpbd", 1, 2), 1));
  return probe.step().substeps;
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
  if (setting.solver == "implicit") {
    def.solver.kind = SolverKind::implicit;
    def.implicit.substeps = setting.substeps;
    def.implicit.iterations = setting.sweeps;
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
