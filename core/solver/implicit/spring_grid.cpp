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

#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(multiply_springs);
WEFT_EXPORT_KERNEL(smooth_grid);
WEFT_EXPORT_KERNEL(dot_product);
WEFT_EXPORT_KERNEL(combine);
WEFT_EXPORT_KERNEL(invert_blocks);

namespace {

/// Whether vectors of any instruction set end with the numbers.
[[maybe_unused]] bool is_whole(std::size_t count) {
  return count % static_cast<std::size_t>(kGridMargin) == 0;
}

}  // namespace

template <class Real>
void multiply(const SpringGrid<Real>& grid, const Real* p, Real* y) {
  WEFT_RUN(multiply_springs, Real)(grid, p, y);
}

template <class Real>
void smooth_from_zero(const SpringGrid<Real>& grid, Real omega, const Real* r, Real* z) {
  WEFT_RUN(smooth_grid, Real)(grid, omega, r, nullptr, z);
}

template <class Real>
void smooth(const SpringGrid<Real>& grid, Real omega, const Real* r, const Real* y, Real* z) {
  WEFT_RUN(smooth_grid, Real)(grid, omega, r, y, z);
}

template <class Real>
double dot(const Real* a, const Real* b, std::size_t count) {
  assert(is_whole(count));
  return WEFT_RUN(dot_product, Real)(a, b, count);
}

template <class Real>
void add_scaled(Real s, const Real* a, Real* y, std::size_t count) {
  assert(is_whole(count));
  WEFT_RUN(combine, Real)(false, s, a, y, count);
}

template <class Real>
void scale_and_add(Real s, const Real* a, Real* y, std::size_t count) {
  assert(is_whole(count));
  WEFT_RUN(combine, Real)(true, s, a, y, count);
}

template <class Real>
void invert_diagonal(SpringGrid<Real>& grid) {
  WEFT_RUN(invert_blocks, Real)(grid);
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

WEFT_INSTANTIATE_FUNCTIONS(multiply, smooth_from_zero, smooth, dot, add_scaled, scale_and_add,
                           invert_diagonal, inverse_of)
template struct SpringGrid<float>;
template struct SpringGrid<double>;

}  // namespace weft
#endif
