// Checks sizes and estimated costs against their limits.

#include "core/world/cost.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/world/constants.h"

namespace weft {
namespace {

std::size_t triangles_of(const ColliderDef& collider) {
  const auto* mesh = std::get_if<MeshDef>(&collider.shape);
  return mesh ? mesh->mesh.triangles.size() : 0;
}

/// All digits, so that the two numbers can be compared.
std::string whole(double value) {
  return std::to_string(std::llround(value));
}

void check_count(const char* field, const char* what, std::size_t count, std::size_t most) {
  if (count <= most) return;
  throw CostError(field, std::to_string(count) + " " + what,
                  "at most " + std::to_string(most) + " " + what + " in all",
                  "use fewer or coarser ones");
}

}  // namespace

void check_size(const WorldDef& def) {
  std::size_t particles = 0, cloth_triangles = 0, object_triangles = 0;
  for (const ClothDef& cloth : def.cloths) {
    const auto rows = static_cast<std::size_t>(std::max(cloth.rows, 0)),
               columns = static_cast<std::size_t>(std::max(cloth.columns, 0));
    particles += cloth.mesh ? cloth.mesh->mesh.positions.size() : rows * columns;
    cloth_triangles += cloth.mesh ? cloth.mesh->mesh.triangles.size() : 2 * rows * columns;
  }
  for (const ColliderDef& collider : def.colliders) object_triangles += triangles_of(collider);
  check_count("cloths", "particles", particles, kMostWorldParticles);
  check_count("cloths", "triangles", cloth_triangles, kMostWorldTriangles);
  check_count("colliders", "triangles", object_triangles, kMostWorldTriangles);
}

double sweeps_of(const WorldDef& def, SolverKind kind) {
  assert(kind != SolverKind::automatic && "solver_of tells which");
  switch (kind) {
    case SolverKind::relaxation:
      return sweeps_taken(def.relaxation);
    case SolverKind::implicit:
      return def.implicit.iterations * kSweepsOfNewton;
    default:
      return def.solver.damping_sweeps;
  }
}

void check_cost(const TickCost& cost, const std::string& field, const std::string& value) {
  assert(cost.particles >= 0 && cost.substeps >= 0 && cost.sweeps >= 0 && cost.tick_rate >= 0);
  if (cost.substeps > kMostSubsteps)
    throw CostError(field, value,
                    "what needs at most " + std::to_string(kMostSubsteps) +
                        " substeps a tick; this needs " + whole(cost.substeps),
                    "take weaker wind, thinner air, softer springs or heavier cloth");
  const double a_tick = cost.updates(), a_second = a_tick * cost.tick_rate;
  if (a_tick <= kMostTickUpdates && a_second <= kMostUpdatesPerSecond) return;
  const bool tick = a_tick > kMostTickUpdates;
  const std::string per = tick ? "a tick" : "a simulated second";
  const std::string estimate = whole(cost.particles) + " particles x " + whole(cost.substeps) +
                               " substeps x " + whole(cost.sweeps) + " sweeps" +
                               (cost.damping > 0 ? " + damping of bending" : "") + " = " +
                               whole(a_tick) + " updates a tick";
  throw CostError(
      field, value,
      "what costs at most " + whole(tick ? kMostTickUpdates : kMostUpdatesPerSecond) +
          " updates of particles " + per + "; this is estimated at " + estimate,
      "take fewer particles, softer springs, weaker wind or thinner air, or fewer substeps and "
      "sweeps");
}

}  // namespace weft
