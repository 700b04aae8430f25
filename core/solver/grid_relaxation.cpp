// Lays out a grid for compliant sweeps.

#include "core/solver/grid_relaxation.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "core/geometry/exact_origin.h"

namespace weft {
namespace {

template <class Real>
Real cells_at(int k, int count) {
  assert(k >= 0 && k < count);
  return k == 0 || k + 1 == count ? Real(1) : Real(2);
}

}  // namespace

template <class Real>
Real* GridRelaxation<Real>::at_origin(Array& array) const {
  return array.data() + 2 * view_.stride + kSweepMargin;
}

template <class Real>
void GridRelaxation<Real>::prepare(const ClothPart<Real>& part) {
  view_ = {};
  if (!part.grid_springs || part.hinges.count > 0) return;
  if (!part.cells.site_stiffening.empty()) return;  // its rows have one factor each
  first_ = static_cast<std::size_t>(part.particles.first);
  springs_ = *part.grid_springs;
  view_.rows = part.rows;
  view_.columns = part.columns;
  const int half = (part.columns + 1) / 2;
  view_.half = (half + kSweepMargin - 1) / kSweepMargin * kSweepMargin + kSweepMargin;
  view_.stride = 2 * view_.half;
  view_.bending = part.quadratic_bending;

  const auto size = static_cast<std::size_t>(view_.stride * (view_.rows + 4) + 4 * kSweepMargin);
  for (std::size_t k = 0; k < 3; ++k) {
    for (Array* array : {&x_[k], &displacement_[k], &force_[k]}) array->assign(size, Real(0));
    view_.x[k] = at_origin(x_[k]);
    view_.displacement[k] = at_origin(displacement_[k]);
    view_.force[k] = at_origin(force_[k]);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    for (Array* array : {&share_[k], &multiplier_[k]}) array->assign(size, Real(0));
    view_.share[k] = at_origin(share_[k]);
    view_.multiplier[k] = at_origin(multiplier_[k]);
  }
  for (Array* array : {&w_, &free_}) array->assign(size, Real(0));
  view_.w = at_origin(w_);
  view_.free = at_origin(free_);

  const auto row_size = static_cast<std::size_t>(view_.stride + 3 * kSweepMargin);
  for (Array* table :
       {&border_, &softer_, &bend_left_, &bend_, &bend_right_, &cell_left_, &cell_right_})
    table->assign(row_size, Real(0));
  const auto origin = [](Array& table) { return table.data() + kSweepMargin; };
  for (int c = 0; c < view_.columns; ++c) {
    const std::ptrdiff_t k = place(0, c);
    const BendingRow<Real> line = bending_row<Real>(c, view_.columns, part.cells.column_stiffening);
    origin(bend_left_)[k] = line.before;
    origin(bend_)[k] = line.here;
    origin(bend_right_)[k] = line.behind;
    origin(cell_left_)[k] = line.cell_before;
    origin(cell_right_)[k] = line.cell_behind;
    origin(border_)[k] = Real(0.5) * line.cells();
    origin(softer_)[k] = Real(1) / origin(border_)[k];
  }
  view_.border = origin(border_);
  view_.softer = origin(softer_);
  view_.bend_left = origin(bend_left_);
  view_.bend = origin(bend_);
  view_.bend_right = origin(bend_right_);
  view_.cell_left = origin(cell_left_);
  view_.cell_right = origin(cell_right_);
  for (int r = 0; r < view_.rows; ++r)
    view_.row_bend.push_back(bending_row<Real>(r, view_.rows, part.cells.row_stiffening));
  view_.length[0] = springs_.rest_warp;
  view_.length[1] = springs_.rest_weft;
  view_.length[2] = springs_.rest_shear;
}

template <class Real>
void GridRelaxation<Real>::set_masses(const std::vector<Real>& inverse_mass, Real softness) {
  assert(fits() && softness >= 0);
  const Real stiffness[3] = {springs_.warp, springs_.weft, springs_.shear};
  for (int kind = 0; kind < 3; ++kind)
    view_.alpha[kind] = stiffness[kind] > 0 ? softness / stiffness[kind] : Real(0);
  Real *w = at_origin(w_), *free = at_origin(free_);
  const int rows = view_.rows, columns = view_.columns;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const Real inverse = inverse_mass[first_ + static_cast<std::size_t>(r * columns + c)];
      w[place(r, c)] = inverse;
      free[place(r, c)] = inverse > 0 ? Real(1) : Real(0);
    }
  }
  const auto share = [&](int kind, Real fraction_of_stiffness, std::ptrdiff_t i, std::ptrdiff_t j) {
    const Real mobility = w[i] + w[j];
    if (!(stiffness[kind] > 0) || mobility == 0) return Real(0);
    return Real(1) / (mobility + view_.alpha[kind] / fraction_of_stiffness);
  };
  for (int r = 0; r < rows; ++r) {
    const Real row_fraction = Real(0.5) * cells_at<Real>(r, rows);
    for (int c = 0; c < columns; ++c) {
      const std::ptrdiff_t here = place(r, c);
      const Real column_fraction = Real(0.5) * cells_at<Real>(c, columns);
      const bool right = c + 1 < columns, below = r + 1 < rows;
      const auto set = [&](std::size_t spring, Real value) {
        at_origin(share_[spring])[here] = value;
      };
      if (right) set(0, share(0, row_fraction, here, place(r, c + 1)));
      if (below) set(1, share(1, column_fraction, here, place(r + 1, c)));
      if (!right || !below) continue;
      set(2, share(2, Real(1), here, place(r + 1, c + 1)));
      set(3, share(2, Real(1), place(r, c + 1), place(r + 1, c)));
    }
  }
}

template <class Real>
template <class Visit>
void GridRelaxation<Real>::for_each_number(Visit&& visit) const {
  assert(fits());
  std::size_t i = first_;
  for (int r = 0; r < view_.rows; ++r) {
    for (int c = 0; c < view_.columns; ++c, ++i) {
      const std::ptrdiff_t here = place(r, c);
      for (int k = 0; k < 3; ++k) visit(i, here, k);
    }
  }
}

template <class Real>
void GridRelaxation<Real>::load(const Vec3Array<Real>& x, const Vec3Array<Real>& v, Real dt) {
  assert(v.size() == x.size() && dt > 0);
  const auto count = static_cast<std::size_t>(view_.rows) * static_cast<std::size_t>(view_.columns);
  std::copy_n(exact_origin<Real>(std::span(x).subspan(first_, count)).data(), 3, view_.origin);
  for_each_number([&](std::size_t i, std::ptrdiff_t here, int k) {
    view_.x[k][here] = x[i][k] - view_.origin[k];
    view_.displacement[k][here] = v[i][k] * dt;
  });
}

template <class Real>
void GridRelaxation<Real>::load_force(const Vec3Array<Real>& force) {
  for_each_number([&](std::size_t i, std::ptrdiff_t here, int k) {
    at_origin(force_[static_cast<std::size_t>(k)])[here] = force[i][k];
  });
}

template <class Real>
void GridRelaxation<Real>::store(Vec3Array<Real>& x, Vec3Array<Real>& v, Real dt) const {
  assert(v.size() == x.size() && dt > 0);
  for_each_number([&](std::size_t i, std::ptrdiff_t here, int k) {
    x[i][k] = view_.origin[k] + view_.x[k][here];
    v[i][k] = view_.displacement[k][here] / dt;
  });
}

template <class Real>
void GridRelaxation<Real>::store_displacements(Vec3Array<Real>& displacement) const {
  for_each_number([&](std::size_t i, std::ptrdiff_t here, int k) {
    displacement[i][k] = view_.displacement[k][here];
  });
}

template class GridRelaxation<float>;
template class GridRelaxation<double>;

}  // namespace weft
