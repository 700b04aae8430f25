#include "core/solver/implicit/multigrid.h"

#include <algorithm>

namespace weft {
namespace {

/// Levels of at most so many lines either way are not made coarser.
constexpr int kCoarsest = 5;
/// Sweeps on the coarsest level.
constexpr int kCoarsestSweeps = 30;
/// Damping of the block Jacobi sweeps: 1 / (0.583 lambda) with the bound lambda = 2.
constexpr double kOmega = 0.857;
/// How much heavier pinned particles are where the coarse levels see them.
constexpr double kPinnedWeight = 1e5;

}  // namespace

template <class Real>
auto Multigrid<Real>::lines(int count) -> Lines {
  Lines l;
  for (int k = 0; k < count; k += 2) l.kept.push_back(k);
  if (l.kept.back() + 1 < count) l.kept.push_back(count - 1);
  for (std::size_t k = 0; k < l.kept.size(); ++k) {
    const bool gap_before = k > 0 && l.kept[k] - l.kept[k - 1] == 2;
    const bool gap_after = k + 1 < l.kept.size() && l.kept[k + 1] - l.kept[k] == 2;
    l.before.push_back(gap_before ? Real(0.5) : Real(0));
    l.after.push_back(gap_after ? Real(0.5) : Real(0));
    const auto coarse = static_cast<int>(k);
    l.first.push_back(coarse);
    l.second.push_back(coarse);
    l.share.push_back(1);
    l.other.push_back(0);
    if (!gap_after) continue;
    l.first.push_back(coarse);
    l.second.push_back(coarse + 1);
    l.share.push_back(Real(0.5));
    l.other.push_back(Real(0.5));
  }
  return l;
}

template <class Real>
void Multigrid<Real>::prepare(const GridLayout& finest) {
  levels_.clear();
  GridLayout layout = finest;
  while (true) {
    Level& level = levels_.emplace_back();
    level.grid.prepare(layout);
    for (GridVector<Real>* vector : {&level.residual, &level.sum, &level.product})
      vector->assign(layout.size(), Real(0));
    if (layout.rows <= kCoarsest && layout.columns <= kCoarsest) break;
    level.rows = lines(layout.rows);
    level.columns = lines(layout.columns);
    layout = GridLayout(static_cast<int>(level.rows.kept.size()),
                        static_cast<int>(level.columns.kept.size()));
  }
  line_.assign(static_cast<std::size_t>(finest.stride), Real(0));
  weighted_.assign(static_cast<std::size_t>(finest.plane), Real(0));
}

/// `to` = sum over fine places of bilinear weight times `from`.
template <class Real>
void Multigrid<Real>::restrict_plane(const Level& fine, const GridLayout& coarse, const Real* from,
                                     Real* to, std::vector<Real>& line) {
  const GridLayout& layout = fine.grid.layout;
  const Lines &rows = fine.rows, &columns = fine.columns;
  for (int r = 0; r < coarse.rows; ++r) {
    const auto k = static_cast<std::size_t>(r);
    const Real *here = from + layout.at(rows.kept[k], 0), *before = here - layout.stride,
               *after = here + layout.stride;
    for (int c = 0; c < layout.columns; ++c)
      line[static_cast<std::size_t>(c + 1)] =
          here[c] + (rows.before[k] * before[c] + rows.after[k] * after[c]);
    line[static_cast<std::size_t>(layout.columns + 1)] = 0;
    Real* const out = to + coarse.at(r, 0);
    for (int c = 0; c < coarse.columns; ++c) {
      const auto n = static_cast<std::size_t>(c);
      const auto at = static_cast<std::size_t>(columns.kept[n] + 1);
      out[c] = line[at] + (columns.before[n] * line[at - 1] + columns.after[n] * line[at + 1]);
    }
  }
}

/// Each coarse spring is the sum of the parallel fine ones about it, by their bilinear weight
/// across it and by the squared part of its length that they cover.
template <class Real>
void Multigrid<Real>::coarsen_springs(const Level& fine, SpringGrid<Real>& coarse) {
  const Lines &rows = fine.rows, &columns = fine.columns;
  const GridLayout& f = fine.grid.layout;
  const auto length = [](const Lines& l, std::size_t k) {
    return k + 1 < l.kept.size() ? l.kept[k + 1] - l.kept[k] : 0;
  };
  // sum over lines about coarse line k of weight times value(line)
  const auto about = [](const Lines& l, std::size_t k, auto&& value) {
    Real sum = value(l.kept[k]);
    if (l.before[k] > 0) sum += l.before[k] * value(l.kept[k] - 1);
    if (l.after[k] > 0) sum += l.after[k] * value(l.kept[k] + 1);
    return sum;
  };
  for (std::size_t e = 0; e < 6; ++e) {
    const auto block = [&](GridSpring kind, int r, int c) {
      return fine.grid.springs[kind][e][static_cast<std::size_t>(f.at(r, c))];
    };
    for (std::size_t r = 0; r < rows.kept.size(); ++r) {
      for (std::size_t c = 0; c < columns.kept.size(); ++c) {
        const int fr = rows.kept[r], fc = columns.kept[c];
        const int down = length(rows, r), along = length(columns, c);
        const auto at =
            static_cast<std::size_t>(coarse.layout.at(static_cast<int>(r), static_cast<int>(c)));
        Real sums[4] = {};
        for (int n = 0; n < along; ++n)
          sums[kAlong] += about(rows, r, [&](int line) { return block(kAlong, line, fc + n); });
        for (int n = 0; n < down; ++n)
          sums[kDown] += about(columns, c, [&](int line) { return block(kDown, fr + n, line); });
        for (int n = 0; n < down; ++n) {
          for (int m = 0; m < along; ++m) {
            sums[kFalling] += block(kFalling, fr + n, fc + m);
            sums[kRising] += block(kRising, fr + n, fc + m);
          }
        }
        const int longer = std::max(down, along);
        const int lengths[4] = {along, down, longer, longer};
        for (std::size_t kind = 0; kind < 4; ++kind) {
          const auto whole = static_cast<Real>(std::max(1, lengths[kind]));
          coarse.springs[kind][e][at] = sums[kind] / (whole * whole);
        }
      }
    }
  }
}

template <class Real>
void Multigrid<Real>::coarsen() {
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    const Level& fine = levels_[k];
    SpringGrid<Real>& coarse = levels_[k + 1].grid;
    coarsen_springs(fine, coarse);
    for (std::size_t e = 0; e < 6; ++e) {
      const Real* own = fine.grid.own[e].data();
      if (k == 0) {
        for (std::size_t n = 0; n < weighted_.size(); ++n)
          weighted_[n] = own[n] * (fine.grid.free[n] > 0 ? Real(1) : Real(kPinnedWeight));
        own = weighted_.data();
      }
      restrict_plane(fine, coarse.layout, own, coarse.own[e].data(), line_);
    }
  }
  for (Level& level : levels_) invert_diagonal(level.grid);
}

template <class Real>
void Multigrid<Real>::add_prolonged(const Level& fine, const GridLayout& coarse, const Real* from,
                                    Real* to) {
  const GridLayout& layout = fine.grid.layout;
  const Lines &rows = fine.rows, &columns = fine.columns;
  const Real* const free = fine.grid.free.data();
  for (int r = 0; r < layout.rows; ++r) {
    const auto k = static_cast<std::size_t>(r);
    const Real *first = from + coarse.at(rows.first[k], 0),
               *second = from + coarse.at(rows.second[k], 0);
    for (int c = 0; c < coarse.columns; ++c)
      line_[static_cast<std::size_t>(c)] = rows.share[k] * first[c] + rows.other[k] * second[c];
    const std::ptrdiff_t row = layout.at(r, 0);
    for (int c = 0; c < layout.columns; ++c) {
      const auto n = static_cast<std::size_t>(c);
      to[row + c] +=
          free[row + c] * (columns.share[n] * line_[static_cast<std::size_t>(columns.first[n])] +
                           columns.other[n] * line_[static_cast<std::size_t>(columns.second[n])]);
    }
  }
}

template <class Real>
void Multigrid<Real>::cycle(std::size_t number, const Real* r, Real* z) {
  Level& level = levels_[number];
  const auto omega = static_cast<Real>(kOmega);
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
    restrict_plane(level, coarse.grid.layout, level.product.data() + d * planes,
                   coarse.residual.data() + d * coarse_planes, line_);
  cycle(number + 1, coarse.residual.data(), coarse.sum.data());
  for (std::size_t d = 0; d < 3; ++d)
    add_prolonged(level, coarse.grid.layout, coarse.sum.data() + d * coarse_planes, z + d * planes);
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
