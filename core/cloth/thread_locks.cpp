// Finds the threads of a model that lock.

#include "core/cloth/thread_locks.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "core/cloth/constants.h"

namespace weft {
namespace {

/// Area that each edge along a thread stands for, by its ends: that of the triangles beside it,
/// because each cell has one at each of its sides.
template <class Real>
std::map<std::pair<Index, Index>, double> areas_of_threads(const ClothModel<Real>& model) {
  std::map<std::pair<Index, Index>, double> areas;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [i, j] = std::minmax(model.triangles[t][k], model.triangles[t][(k + 1) % 3]);
      const auto &a = model.material[static_cast<std::size_t>(i)],
                 &b = model.material[static_cast<std::size_t>(j)];
      const double across = std::min(std::abs(static_cast<double>(b[0] - a[0])),
                                     std::abs(static_cast<double>(b[1] - a[1])));
      if (across < kAlongThread) areas[{i, j}] += static_cast<double>(model.triangle_area[t]);
    }
  }
  return areas;
}

template <class Real>
void lock_edges(double warp, double weft, ClothModel<Real>& model) {
  for (const auto& [ends, area] : areas_of_threads(model)) {
    const auto [i, j] = ends;
    const auto &a = model.material[static_cast<std::size_t>(i)],
               &b = model.material[static_cast<std::size_t>(j)];
    const double du = std::abs(static_cast<double>(b[0] - a[0])),
                 dv = std::abs(static_cast<double>(b[1] - a[1]));
    const double stiffness = area * (du > dv ? warp : weft), per_length = 1 / std::max(du, dv);
    if (stiffness == 0) continue;
    model.locks.push_back(
        {{i, j, j}, static_cast<Real>(per_length), Real(0), static_cast<Real>(stiffness)});
  }
}

template <class Real>
void lock_triangles(double warp, double weft, ClothModel<Real>& model) {
  for (const MembraneTriangle<Real>& t : model.membrane) {
    const auto area = static_cast<double>(t.area);
    if (warp > 0) model.locks.push_back({t.x, t.u1, t.u2, static_cast<Real>(area * warp)});
    if (weft > 0) model.locks.push_back({t.x, t.v1, t.v2, static_cast<Real>(area * weft)});
  }
}

/// Largest row of the locks' matrix over its particle's mass [1/s^2].
template <class Real>
double bound_locks(const ClothModel<Real>& model) {
  std::vector<double> rows(model.mass.size(), 0);
  for (const ThreadLock<Real>& lock : model.locks) {
    const auto g1 = static_cast<double>(lock.g1), g2 = static_cast<double>(lock.g2);
    const std::array<double, 3> weight = {std::abs(g1 + g2), std::abs(g1), std::abs(g2)};
    const double sum = weight[0] + weight[1] + weight[2];
    for (std::size_t k = 0; k < 3; ++k)
      rows[static_cast<std::size_t>(lock.x[k])] +=
          static_cast<double>(lock.stiffness) * weight[k] * sum;
  }
  double most = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    most = std::max(most, rows[i] / static_cast<double>(model.mass[i]));
  return kShakenMargin * most;
}

}  // namespace

template <class Real>
void add_thread_locks(ClothModel<Real>& model) {
  assert(model.parts.size() == 1 && model.locks.empty());
  ClothPart<Real>& part = model.parts.front();
  const FabricDef& fabric = part.fabric;
  if (fabric.locking_strain == 0) return;
  const double more = fabric.locking_factor - 1;
  const double warp = more * fabric.stretch_warp, weft = more * fabric.stretch_weft;
  if (part.membrane.count > 0)
    lock_triangles(warp, weft, model);
  else
    lock_edges(warp, weft, model);
  part.locks = {0, static_cast<Index>(model.locks.size())};
  part.bounds.locking_omega2 = bound_locks(model);
}

template void add_thread_locks(ClothModel<float>&);
template void add_thread_locks(ClothModel<double>&);

}  // namespace weft
