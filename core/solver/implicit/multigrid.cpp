// Builds the levels and runs the V-cycle.

#include "core/solver/implicit/multigrid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/solver/implicit/constants.h"

namespace weft {
namespace {

/// Positions of the lines that a coarser level keeps: every second one, and the last.
std::vector<int> every_second(const std::vector<int>& at) {
  std::vector<int> kept;
  for (std::size_t k = 0; k < at.size(); k += 2) kept.push_back(at[k]);
  if (at.size() % 2 == 0) kept.push_back(at.back());
  return kept;
}

}  // namespace

template <class Real>
void Multigrid<Real>::prepare(const GridLayout& finest, const QuadraticBending<Real>& bending,
                              const GridCells& cells) {
  assert(finest.rows >= 2 && finest.columns >= 2);
  levels_.clear();
  std::vector<int> rows(static_cast<std::size_t>(finest.rows)),
      columns(static_cast<std::size_t>(finest.columns));
  std::iota(rows.begin(), rows.end(), 0);
  std::iota(columns.begin(), columns.end(), 0);
  for (int unit = 1;; unit *= 2) {
    const GridLayout layout(static_cast<int>(rows.size()), static_cast<int>(columns.size()));
    Level& level = levels_.emplace_back();
    level.grid.prepare(layout, unit == 1);
    level.grid.set_bending(bending, cells, rows, columns, unit);
    level.strongest_bending =
        *std::max_element(level.grid.bending_bound.begin(), level.grid.bending_bound.end());
    for (GridVector<Real>* vector : {&level.residual, &level.sum, &level.product})
      vector->assign(layout.size(), Real(0));
    if (layout.rows <= kCoarsestLines && layout.columns <= kCoarsestLines) break;
    rows = every_second(rows);
    columns = every_second(columns);
  }
  lines_.prepare(finest);
  weighted_.assign(static_cast<std::size_t>(finest.plane), Real(0));
}

template <class Real>
void Multigrid<Real>::coarsen() {
  assert(!levels_.empty() && "prepare comes first");
  double mean_inertia = 0;
  for (const Real inertia : finest().inertia) mean_inertia += static_cast<double>(inertia);
  mean_inertia /= finest().layout.rows * finest().layout.columns;
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    const SpringGrid<Real>& fine = levels_[k].grid;
    SpringGrid<Real>& coarse = levels_[k + 1].grid;
    assert(coarse.layout.rows == coarse_count(fine.layout.rows));
    assert(coarse.layout.columns == coarse_count(fine.layout.columns));
    coarsen_springs(fine, coarse, lines_);
    const auto restrict = [&](const AlignedVector<Real>& from, AlignedVector<Real>& to) {
      const Real* numbers = from.data();
      if (k == 0) {
        for (std::size_t n = 0; n < weighted_.size(); ++n)
          weighted_[n] = from[n] * (fine.free[n] > 0 ? Real(1) : Real(kPinnedWeight));
        numbers = weighted_.data();
      }
      restrict_plane(fine.layout, coarse.layout, numbers, to.data(), lines_);
    };
    restrict(fine.inertia, coarse.inertia);
    coarse.bending_counts =
        static_cast<double>(levels_[k + 1].strongest_bending) >
        kSmallBending * mean_inertia * std::pow(4.0, static_cast<double>(k + 1));
    coarse.has_air = fine.has_air;
    for (std::size_t e = 0; fine.has_air && e < 6; ++e) restrict(fine.air[e], coarse.air[e]);
  }
  for (Level& level : levels_) invert_diagonal(level.grid);
}

template <class Real>
void Multigrid<Real>::cycle(std::size_t number, const Real* r, Real* z) {
  assert(number < levels_.size());
  Level& level = levels_[number];
  const auto omega = static_cast<Real>(kJacobiDamping);
  smooth_from_zero(level.grid, omega, r, z);
  if (number + 1 == levels_.size()) {
    for (int s = 1; s < kCoarsestSweeps; ++s) {
      multiply(level.grid, z, level.product.data());
      smooth(level.grid, omega, r, level.product.data(), z);
    }
    return;
  }
  Level& coarse = levels_[number + 1];
  const auto planes = static_cast<std::size_t>(level.grid.layout.plane);
  const auto coarse_planes = static_cast<std::size_t>(coarse.grid.layout.plane);
  multiply(level.grid, z, level.product.data());
  for (std::size_t n = 0; n < level.product.size(); ++n) level.product[n] = r[n] - level.product[n];
  for (std::size_t d = 0; d < 3; ++d)
    restrict_plane(level.grid.layout, coarse.grid.layout, level.product.data() + d * planes,
                   coarse.residual.data() + d * coarse_planes, lines_);
  cycle(number + 1, coarse.residual.data(), coarse.sum.data());
  for (std::size_t d = 0; d < 3; ++d)
    add_prolonged(level.grid.layout, coarse.grid.layout, level.grid.free.data(),
                  coarse.sum.data() + d * coarse_planes, z + d * planes, lines_);
  multiply(level.grid, z, level.product.data());
  smooth(level.grid, omega, r, level.product.data(), z);
}

template <class Real>
void Multigrid<Real>::precondition(const Real* r, Real* z) {
  cycle(0, r, z);
}

template class Multigrid<float>;
template class Multigrid<double>;

}  // namespace weft
