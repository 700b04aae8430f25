// Compiles the matrix operations for each instruction set and dispatches to them.

#include "core/solver/implicit/spring_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/implicit/spring_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/implicit/spring_grid-inl.h"

#if HWY_ONCE
#include <cassert>
#include <cmath>

namespace weft {

HWY_EXPORT(multiply_f32);
HWY_EXPORT(multiply_f64);
HWY_EXPORT(smooth_f32);
HWY_EXPORT(smooth_f64);
HWY_EXPORT(dot_f32);
HWY_EXPORT(dot_f64);
HWY_EXPORT(combine_f32);
HWY_EXPORT(combine_f64);
HWY_EXPORT(invert_f32);
HWY_EXPORT(invert_f64);

namespace {

/// Whether vectors of any instruction set end with the numbers.
[[maybe_unused]] bool is_whole(std::size_t count) {
  return count % static_cast<std::size_t>(kGridMargin) == 0;
}

}  // namespace

void multiply(const SpringGrid<float>& grid, const float* p, float* y) {
  HWY_DYNAMIC_DISPATCH(multiply_f32)(grid, p, y);
}
void multiply(const SpringGrid<double>& grid, const double* p, double* y) {
  HWY_DYNAMIC_DISPATCH(multiply_f64)(grid, p, y);
}
void smooth_from_zero(const SpringGrid<float>& grid, float omega, const float* r, float* z) {
  HWY_DYNAMIC_DISPATCH(smooth_f32)(grid, omega, r, nullptr, z);
}
void smooth_from_zero(const SpringGrid<double>& grid, double omega, const double* r, double* z) {
  HWY_DYNAMIC_DISPATCH(smooth_f64)(grid, omega, r, nullptr, z);
}
void smooth(const SpringGrid<float>& grid, float omega, const float* r, const float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(smooth_f32)(grid, omega, r, y, z);
}
void smooth(const SpringGrid<double>& grid, double omega, const double* r, const double* y,
            double* z) {
  HWY_DYNAMIC_DISPATCH(smooth_f64)(grid, omega, r, y, z);
}
double dot(const float* a, const float* b, std::size_t count) {
  assert(is_whole(count));
  return HWY_DYNAMIC_DISPATCH(dot_f32)(a, b, count);
}
double dot(const double* a, const double* b, std::size_t count) {
  assert(is_whole(count));
  return HWY_DYNAMIC_DISPATCH(dot_f64)(a, b, count);
}
void add_scaled(float s, const float* a, float* y, std::size_t count) {
  assert(is_whole(count));
  HWY_DYNAMIC_DISPATCH(combine_f32)(false, s, a, y, count);
}
void add_scaled(double s, const double* a, double* y, std::size_t count) {
  assert(is_whole(count));
  HWY_DYNAMIC_DISPATCH(combine_f64)(false, s, a, y, count);
}
void scale_and_add(float s, const float* a, float* y, std::size_t count) {
  assert(is_whole(count));
  HWY_DYNAMIC_DISPATCH(combine_f32)(true, s, a, y, count);
}
void scale_and_add(double s, const double* a, double* y, std::size_t count) {
  assert(is_whole(count));
  HWY_DYNAMIC_DISPATCH(combine_f64)(true, s, a, y, count);
}

void invert_diagonal(SpringGrid<float>& grid) {
  HWY_DYNAMIC_DISPATCH(invert_f32)(grid);
}
void invert_diagonal(SpringGrid<double>& grid) {
  HWY_DYNAMIC_DISPATCH(invert_f64)(grid);
}

GridLayout::GridLayout(int row_count, int column_count) : rows(row_count), columns(column_count) {
  assert(row_count >= 2 && column_count >= 2);
  const std::ptrdiff_t whole = (column_count + 2 + kGridMargin - 1) / kGridMargin * kGridMargin;
  stride = whole + kGridMargin;
  origin = 2 * stride + kGridMargin;
  plane = (rows + 4) * stride + 2 * kGridMargin;
}

template <class Real>
void SpringGrid<Real>::prepare(const GridLayout& shape, bool is_factored) {
  layout = shape;
  factored = is_factored;
  const auto size = static_cast<std::size_t>(layout.plane);
  for (auto& blocks : springs) {
    for (std::size_t e = 0; e < (factored ? 4 : 6); ++e) blocks[e].assign(size, Real(0));
  }
  for (auto* blocks : {&air, &inverse}) {
    for (AlignedVector<Real>& numbers : *blocks) numbers.assign(size, Real(0));
  }
  inertia.assign(size, Real(0));
  free.assign(size, Real(0));
  for (int r = 0; r < layout.rows; ++r) {
    for (int c = 0; c < layout.columns; ++c) free[static_cast<std::size_t>(layout.at(r, c))] = 1;
  }
  bending = {};
}

namespace {

template <class Numbers>
auto absolute_sum(const Numbers& numbers) {
  auto sum = numbers[0] * 0;
  for (const auto number : numbers) sum += std::abs(number);
  return sum;
}

/// Half the absolute sum of a particle's row of the bending matrix.
template <class Real>
Real row_bound(const QuadraticBending<Real>& form, const BendingLine<Real>& row,
               const BendingLine<Real>& column) {
  return Real(0.5) * (form.along_u * Real(0.5) * row.width * absolute_sum(column.bend) +
                      form.along_v * Real(0.5) * column.width * absolute_sum(row.bend) +
                      form.twist * absolute_sum(row.slope) * absolute_sum(column.slope));
}

}  // namespace

template <class Real>
void SpringGrid<Real>::set_bending(const QuadraticBending<Real>& form, const GridCells& cells,
                                   const std::vector<int>& rows_at,
                                   const std::vector<int>& columns_at, int unit) {
  assert(static_cast<int>(rows_at.size()) == layout.rows);
  assert(static_cast<int>(columns_at.size()) == layout.columns);
  // A stencil over cells of twice the size has twice the width and an eighth of the value for the
  // same differences.
  const Real size = Real(1) / static_cast<Real>(unit * unit);
  bending = form;
  bending.along_u *= size;
  bending.along_v *= size;
  bending.twist *= size;
  bending_counts = form.along_u != 0 || form.along_v != 0 || form.twist != 0;
  static const std::vector<double> kNoStiffening;
  row_bending =
      bending_lines<Real>(rows_at, unit, unit == 1 ? cells.row_stiffening : kNoStiffening);
  const std::vector<BendingLine<Real>> columns =
      bending_lines<Real>(columns_at, unit, unit == 1 ? cells.column_stiffening : kNoStiffening);
  column_bending.assign(static_cast<std::size_t>(9 * bending_pitch()), Real(0));
  bending_bound.assign(static_cast<std::size_t>(layout.plane), Real(0));
  for (int c = 0; c < layout.columns; ++c) {
    const BendingLine<Real>& column = columns[static_cast<std::size_t>(c)];
    Real* at = column_bending.data() + kGridMargin + c;
    const auto put = [&](Real number) {
      *at = number;
      at += bending_pitch();
    };
    for (const Real number : column.bend) put(number);
    for (const Real number : column.slope) put(number);
    put(column.width);
    for (int r = 0; r < layout.rows; ++r)
      bending_bound[static_cast<std::size_t>(layout.at(r, c))] =
          row_bound(bending, row_bending[static_cast<std::size_t>(r)], column);
  }
}

template <class Real>
std::array<Real, 6> inverse_of(const std::array<Real, 6>& a) {
  const Real cxx = a[3] * a[5] - a[4] * a[4], cxy = a[2] * a[4] - a[1] * a[5];
  const Real cxz = a[1] * a[4] - a[2] * a[3];
  const Real determinant = a[0] * cxx + a[1] * cxy + a[2] * cxz;
  if (!(determinant > 0)) return {};
  const Real s = 1 / determinant;
  return {cxx * s,
          cxy * s,
          cxz * s,
          (a[0] * a[5] - a[2] * a[2]) * s,
          (a[1] * a[2] - a[0] * a[4]) * s,
          (a[0] * a[3] - a[1] * a[1]) * s};
}

#define WEFT_INSTANTIATE(Real)      \
  template struct SpringGrid<Real>; \
  template std::array<Real, 6> inverse_of(const std::array<Real, 6>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
#endif
