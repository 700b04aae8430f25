// Linearises a grid's springs for one instruction set.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_SPRING_PLANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SPRING_PLANES_INL_H
#undef WEFT_SPRING_PLANES_INL_H
#else
#define WEFT_SPRING_PLANES_INL_H
#endif

#include "core/forces/spring.h"
#include "core/math/kernels.h"
#include "core/solver/implicit/grid_planes-inl.h"
#include "core/solver/implicit/spring_planes.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Layout of a row of springs' forces: a line by kind and component, with a margin in front.
template <class Real>
class ForceRow {
 public:
  ForceRow(SpringPlanes<Real>& springs, const GridLayout& layout, int row)
      : line_(layout.stride),
        at_(springs.forces.data() + (row % 2 == 0 ? 0 : 12 * line_) + kGridMargin) {}
  Real* of(std::size_t kind) const { return at_ + static_cast<std::ptrdiff_t>(3 * kind) * line_; }
  template <class D>
  HWY_INLINE Triple<hn::Vec<D>> load(D d, std::size_t kind, std::ptrdiff_t c) const {
    const Real* const at = of(kind) + c;
    return {hn::LoadU(d, at), hn::LoadU(d, at + line_), hn::LoadU(d, at + 2 * line_)};
  }
  template <class D>
  HWY_INLINE void store(D d, std::size_t kind, std::ptrdiff_t c,
                        const Triple<hn::Vec<D>>& force) const {
    store_planes(d, force, line_, of(kind) + c);
  }

 private:
  std::ptrdiff_t line_;
  Real* at_;
};

/// One vector of SpringTerm: force on the first ends, and the blocks.
template <class D, class Real, class V = hn::Vec<D>>
HWY_INLINE Triple<V> spring_term(D d, const SpringPlanes<Real>& springs, std::size_t kind,
                                 std::ptrdiff_t at, Real rate, const Triple<V>& delta,
                                 const Triple<V>& dv, SpringGrid<Real>& grid) {
  const V k = hn::LoadU(d, springs.stiffness[kind].data() + at);
  const V c = hn::LoadU(d, springs.damping[kind].data() + at);
  const V length = hn::LoadU(d, springs.rest_length[kind].data() + at);
  const V zero = hn::Zero(d), one = hn::Set(d, Real(1));
  const V inverse = inverse_root(d, hn::Add(fused_dot(d, delta, delta),
                                            hn::Set(d, static_cast<Real>(kSmallestSquaredLength))));
  const V elastic = hn::Mul(k, fused_minus(d, length, inverse, one));
  const V closing = hn::Mul(hn::Mul(fused_dot(d, delta, dv), inverse), inverse);
  const V across = hn::Max(zero, elastic);
  const V along = hn::Sub(fused(d, c, hn::Set(d, rate), k), across);
  const Triple<V> factor = delta * hn::Mul(inverse, hn::Sqrt(along));
  auto& block = grid.springs[kind];
  hn::StoreU(factor.x, d, block[0].data() + at);
  hn::StoreU(factor.y, d, block[1].data() + at);
  hn::StoreU(factor.z, d, block[2].data() + at);
  hn::StoreU(across, d, block[3].data() + at);
  return delta * fused(d, c, closing, elastic);
}

/// Blocks of the springs that begin in a row of cells, and their forces for `add_up_row`.
template <class Real>
HWY_INLINE void linearise_row(SpringPlanes<Real>& springs, Real rate, const Real* x, const Real* v,
                              int r, SpringGrid<Real>& grid) {
  const hn::ScalableTag<Real> d;
  const GridLayout& layout = grid.layout;
  const PlaneVector<Real> place(layout, x), speed(layout, v);
  const ForceRow<Real> forces(springs, layout, r);
  const std::ptrdiff_t s = layout.stride;
  const std::ptrdiff_t ends[4][2] = {{0, 1}, {0, s}, {0, s + 1}, {1, s}};  // by GridSpring
  for (std::ptrdiff_t c = 0; c < layout.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    const std::ptrdiff_t k = layout.at(r, 0) + c;
    for (std::size_t kind = 0; kind < 4; ++kind) {
      const std::ptrdiff_t i = k + ends[kind][0], j = k + ends[kind][1];
      forces.store(d, kind, c,
                   spring_term(d, springs, kind, k, rate, place(d, j) - place(d, i),
                               speed(d, j) - speed(d, i), grid));
    }
  }
}

/// Second differences about the three places in the middle of five of a line, with factors and the
/// weights 1 -2 1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> bent_line(D d, const Triple<V> (&x)[5], V before, V here, V behind) {
  const Triple<V> a = x[1] - x[0], b = x[2] - x[1], c = x[3] - x[2], e = x[4] - x[3];
  const Triple<V> ends = fused(d, b - a, before, (e - c) * behind);
  return ends - (c - b) * hn::Add(here, here);
}

/// Minus the force of bending on a row of particles. It begins with differences of neighbours,
/// whose rounding is as small as they are: that of places, as in `add_bending`, would not cancel in
/// the sum of all forces.
template <class D, class Real, class V = hn::Vec<D>>
HWY_INLINE Triple<V> bending_pull(D d, const SpringGrid<Real>& g, const PlaneVector<Real>& p, int r,
                                  std::ptrdiff_t c) {
  const std::ptrdiff_t s = g.layout.stride, k = g.layout.at(r, 0) + c;
  const BendingLine<Real>& row = g.row_bending[static_cast<std::size_t>(r)];
  const auto column = [&](std::ptrdiff_t number) HWY_ATTR {
    return hn::LoadU(d, g.column_bending.data() + number * g.bending_pitch() + kGridMargin + c);
  };
  const auto place = [&](std::ptrdiff_t at) HWY_ATTR { return p(d, k + at); };
  // The weight of a place is the factors of the differences beside it and four times its own.
  const auto own = [](Real before, Real here, Real behind) {
    return (here - before - behind) * Real(0.25);
  };
  const V u_before = column(0), u_behind = column(4);
  const V u_here = hn::Mul(hn::Sub(hn::Sub(column(2), u_before), u_behind), hn::Set(d, Real(0.25)));
  const Triple<V> here = place(0), left = place(-1), right = place(1), up = place(-s),
                  down = place(s);
  const Triple<V> u =
      bent_line(d, {place(-2), left, here, right, place(2)}, u_before, u_here, u_behind);
  const Triple<V> v =
      bent_line(d, {place(-2 * s), up, here, down, place(2 * s)}, hn::Set(d, row.bend[0]),
                hn::Set(d, own(row.bend[0], row.bend[2], row.bend[4])), hn::Set(d, row.bend[4]));
  // The twists of the cells between this row and another, the right one's less the left one's.
  const V has_left = column(5), has_right = column(7);  // minus 1 where there is a cell
  const Triple<V> to_left = left - here, to_right = here - right;
  const auto twists = [&](const Triple<V>& other, std::ptrdiff_t at) HWY_ATTR {
    const Triple<V> other_left = place(at - 1) - other, other_right = other - place(at + 1);
    return (to_right - other_right) * has_right - (to_left - other_left) * has_left;
  };
  const Triple<V> twist = fused(d, twists(down, s), hn::Set(d, row.slope[2]),
                                twists(up, -s) * hn::Set(d, row.slope[0]));
  const V along_u = hn::Set(d, g.bending.along_u * Real(0.5) * row.width);
  const V along_v =
      hn::Mul(hn::Set(d, g.bending.along_v), hn::Mul(hn::Set(d, Real(0.5)), column(8)));
  return fused(d, u, along_u, fused(d, v, along_v, twist * hn::Set(d, g.bending.twist)));
}

/// Sums the forces of this row of springs, of the previous one and of bending on a row of
/// particles, in the same order for any vector width.
template <class Real>
HWY_INLINE void add_up_row(SpringPlanes<Real>& springs, const SpringGrid<Real>& grid, const Real* x,
                           int r, Real* force) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<decltype(d)>;
  const GridLayout& layout = grid.layout;
  const PlaneVector<Real> place(layout, x);
  const ForceRow<Real> here(springs, layout, r), above(springs, layout, r + 1);
  const bool bends = grid.bends();
  for (std::ptrdiff_t c = 0; c < layout.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    Triple<V> sum = here.load(d, kAlong, c) - here.load(d, kAlong, c - 1);
    sum = sum + here.load(d, kDown, c) - above.load(d, kDown, c);
    sum = sum + here.load(d, kFalling, c) - above.load(d, kFalling, c - 1);
    sum = sum + here.load(d, kRising, c - 1) - above.load(d, kRising, c);
    if (bends) sum = sum - bending_pull(d, grid, place, r, c);
    store_planes(d, sum, layout.plane, force + layout.at(r, 0) + c);
  }
}

template <class Real>
HWY_ATTR void linearise_grid(SpringPlanes<Real>& springs, Real rate, const Real* x, const Real* v,
                             SpringGrid<Real>& grid, Real* force) {
  for (Real& number : springs.forces) number = 0;
  for (int r = 0; r < grid.layout.rows; ++r) {
    linearise_row(springs, rate, x, v, r, grid);
    add_up_row(springs, grid, x, r, force);
  }
}

WEFT_KERNEL(linearise_grid);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
