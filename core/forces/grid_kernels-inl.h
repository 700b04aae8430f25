// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_KERNELS_INL_H
#undef WEFT_GRID_KERNELS_INL_H
#else
#define WEFT_GRID_KERNELS_INL_H
#endif

#include <algorithm>
#include <cstddef>

#include <hwy/highway.h>

#include "core/forces/grid_pass.h"
#include "core/forces/spring.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> load(D d, const Real* const (&fields)[3], std::ptrdiff_t at) {
  return {hn::LoadU(d, fields[0] + at), hn::LoadU(d, fields[1] + at), hn::LoadU(d, fields[2] + at)};
}

/// Rows of intermediate values: index `row` of the view's scratch space, three components each.
template <class Real>
struct ScratchRow {
  Real* component[3];

  ScratchRow(const GridView<Real>& grid, int index) {
    for (int k = 0; k < 3; ++k) component[k] = grid.scratch + (3 * index + k) * grid.stride;
  }
  template <class D>
  HWY_INLINE Triple<hn::Vec<D>> load(D d, std::ptrdiff_t at) const {
    return {hn::LoadU(d, component[0] + at), hn::LoadU(d, component[1] + at),
            hn::LoadU(d, component[2] + at)};
  }
  template <class D>
  HWY_INLINE void store(D d, std::ptrdiff_t at, const Triple<hn::Vec<D>>& a) const {
    hn::StoreU(a.x, d, component[0] + at);
    hn::StoreU(a.y, d, component[1] + at);
    hn::StoreU(a.z, d, component[2] + at);
  }
  void clear(std::ptrdiff_t columns) const {
    for (Real* values : component) {
      for (std::ptrdiff_t c = 0; c < columns; ++c) values[c] = 0;
    }
  }
};

/// Writes one vector of particles as x y z x y z ..., only `count` of them.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void store_particles(D d, const Triple<hn::Vec<D>>& a, std::ptrdiff_t count, Real* to) {
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  if (count >= lanes) {
    hn::StoreInterleaved3(a.x, a.y, a.z, d, to);
    return;
  }
  Real all[3 * kGridMargin];
  hn::StoreInterleaved3(a.x, a.y, a.z, d, all);
  for (std::ptrdiff_t n = 0; n < 3 * count; ++n) to[n] = all[n];
}

/// One kind of spring of a row: stiffness by lane, rest length and dashpot per stiffness.
template <class D>
struct SpringLaw {
  hn::Vec<D> one, rest_length, damping, smallest;
};

/// Force on the start of springs from their start to their end; the formula of spring.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> spring(const SpringLaw<D>& law, V stiffness, const Triple<V>& d,
                            const Triple<V>& dv) {
  const V l2 = hn::Add(dot(d, d), law.smallest);
  const V per_l = hn::Div(law.one, hn::Sqrt(l2));
  const V elastic = hn::Sub(law.one, hn::Mul(law.rest_length, per_l));
  const V rate = hn::Mul(dot(d, dv), hn::Mul(per_l, per_l));
  return d * hn::Mul(stiffness, hn::Add(elastic, hn::Mul(law.damping, rate)));
}

/// Second differences down the columns of row r, times their stiffness; zero on the border rows.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void bend_down_columns(D d, const GridView<Real>& g, int r,
                                  const ScratchRow<Real>& out) {
  if (r <= 0 || r >= g.rows - 1) {
    out.clear(g.columns);
    return;
  }
  const auto two = hn::Set(d, Real(2)), k = hn::Set(d, g.bending.along_v);
  const std::ptrdiff_t row = r * g.stride;
  for (std::ptrdiff_t c = 0; c < g.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    const auto second = (load(d, g.x, row - g.stride + c) - load(d, g.x, row + c) * two) +
                        load(d, g.x, row + g.stride + c);
    out.store(d, c, second * hn::Mul(k, hn::LoadU(d, g.border_half + c)));
  }
}

/// What the springs and stencils that start in one row pull, column by column.
template <class Real>
struct RowPulls {
  ScratchRow<Real> along, down, falling, rising, bend, twist;

  RowPulls(const GridView<Real>& g, int first)
      : along(g, first), down(g, first + 1), falling(g, first + 2), rising(g, first + 3),
        bend(g, first + 4), twist(g, first + 5) {}
};

template <class D>
struct SpringLaws {
  SpringLaw<D> warp, weft, shear;
};

/// Evaluates everything that starts in row r.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void pull_row(D d, const GridView<Real>& g, const SpringLaws<D>& laws, int r,
                         const RowPulls<Real>& out) {
  const std::ptrdiff_t row = r * g.stride;
  const bool border = r == 0 || r == g.rows - 1, last = r == g.rows - 1;
  const Real share = border ? Real(0.5) : Real(1), below = last ? Real(0) : Real(1);
  const auto two = hn::Set(d, Real(2));
  const auto k_warp = hn::Set(d, share * g.springs.warp),
             k_weft = hn::Set(d, below * g.springs.weft);
  const auto k_shear = hn::Set(d, below * g.springs.shear);
  const auto k_bend = hn::Set(d, share * g.bending.along_u);
  const auto k_twist = hn::Set(d, below * g.bending.twist);
  for (std::ptrdiff_t c = 0; c < g.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    const std::ptrdiff_t at = row + c, under = at + g.stride;
    const auto cell = hn::LoadU(d, g.cell + c);
    const auto x = load(d, g.x, at), xr = load(d, g.x, at + 1), xd = load(d, g.x, under),
               xe = load(d, g.x, under + 1);
    const auto v = load(d, g.v, at), vr = load(d, g.v, at + 1), vd = load(d, g.v, under),
               ve = load(d, g.v, under + 1);
    out.along.store(d, c, spring(laws.warp, hn::Mul(k_warp, cell), xr - x, vr - v));
    out.down.store(
        d, c, spring(laws.weft, hn::Mul(k_weft, hn::LoadU(d, g.border_half + c)), xd - x, vd - v));
    out.falling.store(d, c, spring(laws.shear, hn::Mul(k_shear, cell), xe - x, ve - v));
    out.rising.store(d, c, spring(laws.shear, hn::Mul(k_shear, cell), xd - xr, vd - vr));
    out.bend.store(
        d, c, ((load(d, g.x, at - 1) - x * two) + xr) * hn::Mul(k_bend, hn::LoadU(d, g.inner + c)));
    out.twist.store(d, c, ((x - xr) - (xd - xe)) * hn::Mul(k_twist, cell));
  }
}

/// Row r is added up only after row r + 1 has been evaluated: what was just stored cannot be loaded
/// again at another offset before it has left the store buffer.
template <class Real>
HWY_INLINE void internal_forces(const GridView<Real>& g, Real* force) {
  using D = hn::CappedTag<Real, kGridMargin>;
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const RowPulls<Real> sets[] = {{g, 0}, {g, 6}};
  const ScratchRow<Real> carry(g, 12), column_bend[] = {{g, 13}, {g, 14}, {g, 15}};
  const auto law = [&](Real rest_length) {
    return SpringLaw<D>{hn::Set(d, Real(1)), hn::Set(d, rest_length),
                        hn::Set(d, g.springs.damping_per_stiffness),
                        hn::Set(d, Real(kSmallestSquaredLength))};
  };
  const SpringLaws<D> laws{law(g.springs.rest_warp), law(g.springs.rest_weft),
                           law(g.springs.rest_shear)};
  const auto two = hn::Set(d, Real(2));
  carry.clear(g.columns);
  column_bend[0].clear(g.columns);
  column_bend[2].clear(g.columns);
  bend_down_columns(d, g, 1, column_bend[1]);
  pull_row(d, g, laws, 0, sets[0]);
  for (int r = 0; r < g.rows; ++r) {
    if (r + 1 < g.rows) pull_row(d, g, laws, r + 1, sets[(r + 1) % 2]);
    const RowPulls<Real>& p = sets[r % 2];
    const ScratchRow<Real>&above = column_bend[(r + 2) % 3], &here = column_bend[r % 3],
          &below = column_bend[(r + 1) % 3];
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const auto twisted = p.twist.load(d, c) - p.twist.load(d, c - 1);
      const auto stretched = ((p.along.load(d, c) - p.along.load(d, c - 1)) + p.down.load(d, c)) +
                             (p.falling.load(d, c) + p.rising.load(d, c - 1));
      const auto bent =
          ((p.bend.load(d, c - 1) - p.bend.load(d, c) * two) + p.bend.load(d, c + 1)) +
          ((above.load(d, c) - here.load(d, c) * two) + below.load(d, c));
      const auto total = ((carry.load(d, c) + stretched) - bent) - twisted;
      carry.store(d, c,
                  twisted - ((p.down.load(d, c) + p.rising.load(d, c)) + p.falling.load(d, c - 1)));
      // What goes beyond the row is written over by the next one.
      store_particles(d, total, static_cast<std::ptrdiff_t>(g.rows - r) * g.columns - c,
                      force + 3 * (static_cast<std::ptrdiff_t>(r) * g.columns + c));
    }
    bend_down_columns(d, g, r + 2, column_bend[(r + 2) % 3]);
  }
}

/// A third of the force of the air on triangles (a, b, c); the formula of air.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> air_third(D d, V pressure, V skin, const Triple<V>& a, const Triple<V>& b,
                               const Triple<V>& c, const Triple<V>& slip_sum) {
  using Real = hn::TFromD<D>;
  const V third = hn::Set(d, Real(1.0 / 3.0)), one = hn::Set(d, Real(1));
  const auto normal = cross(b - a, c - a);
  const auto u = slip_sum * third;
  const V length2 = dot(normal, normal);
  const auto degenerate = hn::Le(length2, hn::Zero(d));
  const V per_length = hn::Div(one, hn::Sqrt(hn::IfThenElse(degenerate, one, length2)));
  const V area = hn::Mul(hn::Set(d, Real(0.5)), hn::Mul(length2, per_length));
  const V un = hn::Mul(dot(u, normal), per_length);
  const V thirds = hn::Mul(third, area);
  const V along_n = hn::Mul(hn::Mul(thirds, un), hn::Sub(hn::Mul(pressure, hn::Abs(un)), skin));
  return normal * hn::Mul(along_n, per_length) + u * hn::Mul(thirds, skin);
}

/// What the air pushes at the corners of the cells below one row: a above left, b right of it, f
/// below a, e below b.
template <class Real>
struct CellPushes {
  ScratchRow<Real> a, b, e, f;

  CellPushes(const GridView<Real>& g, int first)
      : a(g, first), b(g, first + 1), e(g, first + 2), f(g, first + 3) {}
};

/// Velocity of the air past particles.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> slip(D d, const GridView<Real>& g, std::ptrdiff_t at) {
  return load(d, g.wind, at) - load(d, g.v, at);
}

template <class D, class Real = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE void push_row(D d, const GridView<Real>& g, V pressure, V skin, int r,
                         const CellPushes<Real>& out) {
  const std::ptrdiff_t row = r * g.stride;
  const auto row_parity = hn::Set(d, static_cast<Real>(r % 2));
  const auto below = hn::Set(d, r + 1 < g.rows ? Real(1) : Real(0));
  for (std::ptrdiff_t c = 0; c < g.columns; c += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    const std::ptrdiff_t at = row + c, under = at + g.stride;
    const auto a = load(d, g.x, at), b = load(d, g.x, at + 1), e = load(d, g.x, under + 1),
               f = load(d, g.x, under);
    const auto sa = slip(d, g, at), sb = slip(d, g, at + 1), se = slip(d, g, under + 1),
               sf = slip(d, g, under);
    // Even cells are cut from a to e, odd ones from b to f (split_cells in grid_cells.h).
    const auto even = hn::Eq(hn::LoadU(d, g.odd + c), row_parity);
    const auto exists = hn::Mul(below, hn::LoadU(d, g.cell + c));
    const auto first =
        air_third(d, pressure, skin, a, b, select(even, e, f), (sa + sb) + select(even, se, sf)) *
        exists;
    const auto second =
        air_third(d, pressure, skin, select(even, a, b), e, f, (select(even, sa, sb) + se) + sf) *
        exists;
    out.a.store(d, c, first + keep_if(even, second));
    out.b.store(d, c, first + keep_if(hn::Not(even), second));
    out.e.store(d, c, second + keep_if(even, first));
    out.f.store(d, c, second + keep_if(hn::Not(even), first));
  }
}

template <class Real>
HWY_INLINE void air_forces(const GridView<Real>& g, Real rho_half, Real skin_friction,
                           Real* force) {
  const hn::CappedTag<Real, kGridMargin> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto pressure = hn::Set(d, rho_half), skin = hn::Set(d, skin_friction);
  const CellPushes<Real> sets[] = {{g, 0}, {g, 4}};
  const ScratchRow<Real> carry(g, 12);
  carry.clear(g.columns);
  push_row(d, g, pressure, skin, 0, sets[0]);
  for (int r = 0; r < g.rows; ++r) {
    if (r + 1 < g.rows) push_row(d, g, pressure, skin, r + 1, sets[(r + 1) % 2]);
    const CellPushes<Real>& p = sets[r % 2];
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const auto total = carry.load(d, c) + (p.a.load(d, c) + p.b.load(d, c - 1));
      carry.store(d, c, p.f.load(d, c) + p.e.load(d, c - 1));
      // What goes beyond the row is written over by the next one.
      store_particles(d, total, static_cast<std::ptrdiff_t>(g.rows - r) * g.columns - c,
                      force + 3 * (static_cast<std::ptrdiff_t>(r) * g.columns + c));
    }
  }
}

/// Takes the numbers of each row apart into the three components.
template <class Real>
HWY_INLINE void take_apart(const GridView<Real>& g, const Real* from, Real* const (&to)[3]) {
  const hn::CappedTag<Real, kGridMargin> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    const Real* particles = from + 3 * r * g.columns;
    std::ptrdiff_t c = 0;
    for (; c < g.columns && lanes <= g.columns; c += lanes) {
      c = std::min(c, g.columns - lanes);  // the last one overlaps the one before
      hn::Vec<decltype(d)> x, y, z;
      hn::LoadInterleaved3(d, particles + 3 * c, x, y, z);
      hn::StoreU(x, d, to[0] + r * g.stride + c);
      hn::StoreU(y, d, to[1] + r * g.stride + c);
      hn::StoreU(z, d, to[2] + r * g.stride + c);
    }
    for (; c < g.columns; ++c) {
      for (int k = 0; k < 3; ++k) to[k][r * g.stride + c] = particles[3 * c + k];
    }
  }
}

HWY_ATTR void take_apart_f32(const GridView<float>& grid, const float* from,
                             float* const (&to)[3]) {
  take_apart(grid, from, to);
}
HWY_ATTR void take_apart_f64(const GridView<double>& grid, const double* from,
                             double* const (&to)[3]) {
  take_apart(grid, from, to);
}
HWY_ATTR void internal_forces_f32(const GridView<float>& grid, float* force) {
  internal_forces(grid, force);
}
HWY_ATTR void internal_forces_f64(const GridView<double>& grid, double* force) {
  internal_forces(grid, force);
}
HWY_ATTR void air_forces_f32(const GridView<float>& grid, float pressure, float skin,
                             float* force) {
  air_forces(grid, pressure, skin, force);
}
HWY_ATTR void air_forces_f64(const GridView<double>& grid, double pressure, double skin,
                             double* force) {
  air_forces(grid, pressure, skin, force);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
