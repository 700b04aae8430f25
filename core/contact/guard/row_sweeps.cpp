// Chooses the rows that respond, starts them from their last impulses, and sweeps them.

#include "core/contact/guard/row_sweeps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

#include "core/contact/guard/constants.h"
#include "core/contact/guard/row_blocks.h"
#include "core/contact/parts.h"
#include "core/instantiate.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Calls copy(elements, first) for each part of an array.
template <class Array, class Copy>
void copy_all(Executor* executor, const Array& array, Copy&& copy) {
  const std::span all(array);
  run_parts(executor, all.size(), parts_of(all.size(), kCopiesAtLeast),
            [&](std::size_t, std::size_t from, std::size_t to) {
              copy(all.subspan(from, to - from), from);
            });
}

template <class Real>
bool are_most(const RowSlabs<Real>& slabs, std::size_t particles) {
  return slabs.particles() * kCostOfOne > particles;
}

/// Whether a row pushes or may within a time [s]. Forgets the slip of one that does not.
template <class Real>
bool is_busy(const QuadArray<Real>& x, const QuadArray<Real>& v, Real time, GuardRow<Real>& row) {
  if (row.push != 0) return true;
  const Real room = dot(row.normal, weighted(row, x)) - row.radius;
  const Real approach = -dot(row.normal, weighted(row, v));
  if (!(room > row.radius * Real(kBusyRoom) + std::max(Real(0), approach) * time)) return true;
  row.slip = {};
  return false;
}

}  // namespace

template <class Real>
void copy_in(const Vec3Array<Real>& from, QuadArray<Real>& to, Executor* executor) {
  assert(from.size() == to.size());
  copy_all(executor, from, [&](auto part, std::size_t at) { to_quads(part, &to[at]); });
}

template <class Real>
void load_velocities(const Vec3Array<Real>& from, const RowSlabs<Real>& slabs, QuadArray<Real>& to,
                     Executor* executor) {
  if (are_most(slabs, from.size())) {
    copy_in(from, to, executor);
    return;
  }
  slabs.visit_particles(executor, [&](Index k) {
    const auto i = at_index(k);
    to[i] = to_quad(from[i]);
  });
}

template <class Real>
void store_velocities(const QuadArray<Real>& from, const RowSlabs<Real>& slabs, Vec3Array<Real>& to,
                      Executor* executor) {
  assert(from.size() == to.size());
  if (are_most(slabs, to.size())) {
    copy_all(executor, from, [&](auto part, std::size_t at) { to_vectors(part, &to[at]); });
    return;
  }
  slabs.visit_particles(executor, [&](Index k) {
    const auto i = at_index(k);
    to[i] = to_vector(from[i]);
  });
}

template <class Real>
void find_busy_rows(const QuadArray<Real>& x, const QuadArray<Real>& v, Real dt, RowSet<Real>& rows,
                    Executor* executor) {
  assert(dt > 0);
  if (!std::exchange(rows.in_slabs, true)) {
    rows.slabs.clear();
    for (std::size_t k = 0; k < rows.all.size(); ++k)
      rows.slabs.add(static_cast<Index>(k), rows.all[k].particle);
  }
  const Real time = dt * Real(kStepsBetweenLooks * kBusyApproach);
  rows.slabs.choose(executor, [&x, &v, &rows, time](Index k) {
    return is_busy(x, v, time, rows.all[at_index(k)]);
  });
}

template <class Real>
void measure_pressures(const std::vector<Real>& inverse_area, Real kicked, RowSet<Real>& rows,
                       Executor* executor) {
  rows.slabs.visit_particles(executor, [&](Index i) { rows.pressure[at_index(i)] = 0; });
  rows.most_pressure = rows.slabs.largest(executor, [&](Index k) {
    const GuardRow<Real>& row = rows.all[at_index(k)];
    Real most = 0;
    if (row.push == 0) return most;
    const Real force = row.push / (2 * kicked);
    for (std::size_t n = 0; n < 4; ++n) {
      const auto i = at_index(row.particle[n]);
      rows.pressure[i] += std::abs(row.weight[n]) * force * inverse_area[i];
      most = std::max(most, rows.pressure[i]);
    }
    return most;
  });
}

template <class Real>
void warm_start(const QuadArray<Real>& x, Real dt, Real kicked, RowSet<Real>& rows,
                RowSweeps<Real>& sweeps, Executor* executor) {
  assert(dt > 0 && kicked > 0);
  const Real warm = sweeps.kicked > 0 ? kicked / sweeps.kicked : Real(0);
  sweeps.kicked = kicked;
  const RowPass<Real> pass{x.data(), sweeps.v.data(), rows.pressure.data(), rows.most_pressure, dt,
                           warm};
  const Real lacks = rows.deals.largest(
      executor, true, [&](auto blocks) { return warm_rows(blocks, pass) ? Real(1) : Real(0); });
  sweeps.lack = lacks > 0;
}

template <class Real>
Real sweep_once(const QuadArray<Real>& x, RowSet<Real>& rows, RowSweeps<Real>& sweeps,
                Executor* executor) {
  stop_point();
  const bool upwards = sweeps.upwards = !sweeps.upwards;
  const RowPass<Real> pass{x.data(), sweeps.v.data(), nullptr, 0, 0, 0};
  return rows.deals.largest(executor, upwards,
                            [&](auto blocks) { return sweep_rows(blocks, upwards, pass); });
}

WEFT_INSTANTIATE_FUNCTIONS(copy_in, load_velocities, store_velocities, find_busy_rows,
                           measure_pressures, warm_start, sweep_once)

}  // namespace weft
