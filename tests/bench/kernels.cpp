#include "tests/bench/kernels.h"

#include <algorithm>
#include <numeric>

#include "core/world/world.h"
#include "tests/bench/cases.h"
#include "tests/bench/measures.h"
#include "tests/support/random.h"

namespace weft::bench {
namespace {

const BenchScene& swing_scene() {
  return bench_scenes().front();
}

/// The cloth of a swing as a mesh, its vertices in random order.
WorldDef as_mesh(WorldDef def) {
  ClothDef& cloth = def.cloths[0];
  const int n = cloth.rows;
  std::vector<Index> place(static_cast<std::size_t>(n * n));
  std::iota(place.begin(), place.end(), 0);
  test::Random random(11);
  for (Index k = n * n - 1; k > 0; --k)
    std::swap(place[static_cast<std::size_t>(k)],
              place[static_cast<std::size_t>(random.index(k + 1))]);
  ClothMesh mesh;
  mesh.mesh.positions.resize(place.size());
  const auto vertex = [&](int r, int c) { return place[static_cast<std::size_t>(r * n + c)]; };
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      mesh.mesh.positions[static_cast<std::size_t>(vertex(r, c))] =
          Vec3d(c * cloth.width / (n - 1), 0, r * cloth.height / (n - 1));
      if (r + 1 == n || c + 1 == n) continue;
      const Index a = vertex(r, c), b = vertex(r, c + 1), e = vertex(r + 1, c + 1),
                  f = vertex(r + 1, c);
      const bool even = (r + c) % 2 == 0;
      mesh.mesh.triangles.push_back(even ? Triangle{a, f, e} : Triangle{a, f, b});
      mesh.mesh.triangles.push_back(even ? Triangle{a, e, b} : Triangle{f, e, b});
    }
  }
  cloth.mesh = mesh;
  def.pins.clear();
  for (int c = 0; c < n; ++c) def.pins.push_back({vertex(0, c), 0, {}});
  return def;
}

WorldDef with_edge_springs(WorldDef def) {
  def.cloths[0].membrane_model = MembraneModel::springs;
  return def;
}

/// A world whose ticks are timed in turn with those of others.
struct Timed {
  World<float> world;
  double work_per_tick = 0;       ///< particles times substeps times sweeps
  std::vector<double> seconds{};  ///< of one tick, by run

  explicit Timed(const WorldDef& def, int sweeps = 1) : world(def) {
    work_per_tick = static_cast<double>(world.step().substeps) * sweeps *
                    static_cast<double>(world.state().x.size());
  }
  void run(int ticks) {
    const double start = cpu_seconds();
    for (int k = 0; k < ticks; ++k) world.step();
    seconds.push_back((cpu_seconds() - start) / ticks);
  }
  double nanoseconds() const { return 1e9 * median(seconds) / work_per_tick; }
};

KernelFigure figure(const char* name, const Timed& timed, double bar) {
  return {name, "ns", timed.nanoseconds(), bar, static_cast<int>(timed.seconds.size())};
}

/// What the solver takes, as the world is.
KernelFigure memory(const char* name, const World<float>& world) {
  return {name, "B",
          static_cast<double>(world.solver_bytes()) / static_cast<double>(world.state().x.size()),
          100, 1};
}

WorldDef in_wind(WorldDef def) {
  def.environment.air_density = 1.225;
  def.environment.wind = Vec3d(6, 0, 0.8);
  return def;
}

/// A sling is fired, which allocates arrays for its force.
KernelFigure memory_with_impulse(const char* name, World<float> world) {
  GrabDef sling;
  sling.mode = GrabMode::sling;
  sling.target = Vec3d(0.5, 1, 0.5);
  const GrabId id = world.grab(sling);
  world.step();
  world.fire(id);
  world.step();
  return memory(name, world);
}

WorldDef relaxing(const WorldDef& def, int substeps, int sweeps, double compliance) {
  Setting setting{compliance > 0 ? "xpbd" : "relaxation", "", 1, 1, substeps, sweeps};
  return with_setting(def, setting, 1);
}

/// How the cost of a swing is found.
struct Swing {
  SolverKind solver;
  int runs, ticks;  ///< `ticks` in each run
};

/// CPU seconds a simulated second of a swing.
double swing_cost(int n, const FabricDef& fabric, const Swing& swing) {
  WorldDef def = swing_scene().make(n, fabric);
  def.solver.kind = swing.solver;
  Timed timed(def);
  for (int k = 0; k < swing.runs; ++k) timed.run(swing.ticks);
  return median(timed.seconds) / timed.world.tick_seconds();
}

KernelFigure largest_in_real_time(const BenchFabric& fabric, const Swing& swing) {
  int low = 16, high = 512;  // low holds, high does not
  while (high - low > std::max(1, low / 64)) {
    const int middle = (low + high) / 2;
    (swing_cost(middle, fabric.fabric, swing) <= 0.5 ? low : high) = middle;
  }
  const char* solver = swing.solver == SolverKind::implicit ? ", implicit" : "";
  return {std::string("largest N in real time on half a core, ") + fabric.name + solver,
          "particles a side", static_cast<double>(low), 0, swing.runs};
}

}  // namespace

std::vector<KernelFigure> measure_kernels(bool quick) {
  const FabricDef soft = bench_fabrics().front().fabric;
  const auto swing = [&](int n) { return swing_scene().make(n, soft); };
  Timed grid(swing(128)), small_grid(swing(64)), mesh(as_mesh(swing(quick ? 64 : 128)));
  Timed net(with_edge_springs(as_mesh(swing(quick ? 64 : 128))));
  Timed xpbd(relaxing(swing(64), 128, 2, 1), 2), xpbd_sweeps(relaxing(swing(64), 16, 8, 1), 8);
  Timed seed(relaxing(swing(64), 1, 50, 0), 50);
  const int runs = 5, ticks = quick ? 1 : 4;
  for (int k = 0; k < runs; ++k) {
    for (Timed* timed : {&grid, &small_grid, &mesh, &net, &xpbd, &xpbd_sweeps, &seed})
      timed->run(ticks);
  }
  std::vector<KernelFigure> figures = {
      figure("verlet on a grid of 128 x 128, with dashpots, a particle and substep", grid, 3),
      figure("verlet on a grid of 64 x 64, with dashpots, a particle and substep", small_grid, 0),
      figure("verlet on a triangle mesh, gathers, a particle and substep", mesh, 12),
      figure("verlet on the same mesh with springs along its edges, a particle and substep", net,
             0),
      figure("XPBD on a grid of 64 x 64, 128 substeps of 2 sweeps, a particle and sweep", xpbd, 8),
      figure("XPBD on a grid of 64 x 64, 16 substeps of 8 sweeps, a particle and sweep",
             xpbd_sweeps, 8),
      figure("the seed's relaxation on 64 x 64, 50 sweeps, a particle and sweep", seed, 0),
      memory("memory of verlet on a grid of 128 x 128, a particle", grid.world),
      memory("memory of verlet on a grid of 128 x 128 in wind, a particle",
             World<float>(in_wind(swing(128)))),
      memory_with_impulse(
          "memory of verlet on a grid of 128 x 128 after a sling's shot, a particle",
          World<float>(swing(128))),
      memory("memory of verlet on a triangle mesh, a particle", mesh.world)};
  // Each of verlet's ticks costs the same; those of implicit do not, so it swings for a second.
  for (const BenchFabric& fabric : bench_fabrics()) {
    figures.push_back(largest_in_real_time(fabric, {SolverKind::verlet, quick ? 1 : 5, 2}));
    figures.push_back(largest_in_real_time(fabric, {SolverKind::implicit, 1, quick ? 4 : 60}));
  }
  return figures;
}

}  // namespace weft::bench
