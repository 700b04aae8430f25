// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_KERNELS_INL_H
#undef WEFT_GRID_KERNELS_INL_H
#else
#define WEFT_GRID_KERNELS_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/forces/grid_pass.h"
#include "core/forces/spring.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Three components in vector registers, one particle (or spring, or triangle) a lane.
template <class V>
struct Triple {
  V x, y, z;
};

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> load(D d, const Real* const (&fields)[3], std::ptrdiff_t at) {
  return {hn::LoadU(d, fields[0] + at), hn::LoadU(d, fields[1] + at), hn::LoadU(d, fields[2] + at)};
}

template <class V>
HWY_INLINE Triple<V> operator-(const Triple<V>& a, const Triple<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <class V>
HWY_INLINE Triple<V> operator+(const Triple<V>& a, const Triple<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

template <class V>
HWY_INLINE Triple<V> operator*(const Triple<V>& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

template <class V>
HWY_INLINE V dot(const Triple<V>& a, const Triple<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <class V>
HWY_INLINE Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

template <class M, class V>
HWY_INLINE Triple<V> select(M mask, const Triple<V>& yes, const Triple<V>& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

template <class M, class V>
HWY_INLINE Triple<V> keep_if(M mask, const Triple<V>& a) {
  return {hn::IfThenElseZero(mask, a.x), hn::IfThenElseZero(mask, a.y),
          hn::IfThenElseZero(mask, a.z)};
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
HWY_INLINE void bend_down_columns(D d, const GridView<Real>& g, int r, const ScratchRow<Real>& out) {
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

template <class Real>
HWY_INLINE void internal_forces(const GridView<Real>& g, Real* force) {
  const hn::CappedTag<Real, kGridMargin> d;
  using D = decltype(d);
  using V = hn::Vec<D>;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const ScratchRow<Real> along(g, 0), down(g, 1), falling(g, 2), rising(g, 3), bend(g, 4),
      twist(g, 5), carry(g, 6);
  const ScratchRow<Real> column_bend[] = {{g, 7}, {g, 8}, {g, 9}};
  const auto law = [&](Real rest_length) {
    return SpringLaw<D>{hn::Set(d, Real(1)), hn::Set(d, rest_length),
                        hn::Set(d, g.springs.damping_per_stiffness),
                        hn::Set(d, Real(kSmallestSquaredLength))};
  };
  const SpringLaw<D> warp = law(g.springs.rest_warp), weft = law(g.springs.rest_weft),
                     shear = law(g.springs.rest_shear);
  const V two = hn::Set(d, Real(2));
  carry.clear(g.columns);
  bend_down_columns(d, g, 0, column_bend[0]);
  column_bend[2].clear(g.columns);

  for (int r = 0; r < g.rows; ++r) {
    const std::ptrdiff_t row = r * g.stride;
    const bool border = r == 0 || r == g.rows - 1, last = r == g.rows - 1;
    const Real share = border ? Real(0.5) : Real(1), below = last ? Real(0) : Real(1);
    const V k_warp = hn::Set(d, share * g.springs.warp), k_weft = hn::Set(d, below * g.springs.weft);
    const V k_shear = hn::Set(d, below * g.springs.shear);
    const V k_bend = hn::Set(d, share * g.bending.along_u), k_twist = hn::Set(d, below * g.bending.twist);
    bend_down_columns(d, g, r + 1, column_bend[(r + 1) % 3]);
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const std::ptrdiff_t at = row + c, under = at + g.stride;
      const V cell = hn::LoadU(d, g.cell + c);
      const auto x = load(d, g.x, at), xr = load(d, g.x, at + 1), xd = load(d, g.x, under),
                 xe = load(d, g.x, under + 1);
      const auto v = load(d, g.v, at), vr = load(d, g.v, at + 1), vd = load(d, g.v, under),
                 ve = load(d, g.v, under + 1);
      along.store(d, c, spring(warp, hn::Mul(k_warp, cell), xr - x, vr - v));
      down.store(d, c, spring(weft, hn::Mul(k_weft, hn::LoadU(d, g.border_half + c)), xd - x, vd - v));
      falling.store(d, c, spring(shear, hn::Mul(k_shear, cell), xe - x, ve - v));
      rising.store(d, c, spring(shear, hn::Mul(k_shear, cell), xd - xr, vd - vr));
      bend.store(d, c, ((load(d, g.x, at - 1) - x * two) + xr) *
                           hn::Mul(k_bend, hn::LoadU(d, g.inner + c)));
      twist.store(d, c, ((x - xr) - (xd - xe)) * hn::Mul(k_twist, cell));
    }
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const auto twisted = twist.load(d, c) - twist.load(d, c - 1);
      const auto stretched = ((along.load(d, c) - along.load(d, c - 1)) + down.load(d, c)) +
                             (falling.load(d, c) + rising.load(d, c - 1));
      const auto bent = ((bend.load(d, c - 1) - bend.load(d, c) * two) + bend.load(d, c + 1)) +
                        ((column_bend[(r + 2) % 3].load(d, c) - column_bend[r % 3].load(d, c) * two) +
                         column_bend[(r + 1) % 3].load(d, c));
      const auto total = ((carry.load(d, c) + stretched) - bent) - twisted;
      carry.store(d, c, twisted - ((down.load(d, c) + rising.load(d, c)) + falling.load(d, c - 1)));
      store_particles(d, total, g.columns - c, force + 3 * (static_cast<std::ptrdiff_t>(r) * g.columns + c));
    }
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

template <class Real>
HWY_INLINE void air_forces(const GridView<Real>& g, Real rho_half, Real skin_friction, Real* force) {
  const hn::CappedTag<Real, kGridMargin> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto pressure = hn::Set(d, rho_half), skin = hn::Set(d, skin_friction);
  const ScratchRow<Real> on_b(g, 0), on_e(g, 1), on_a(g, 2), on_d(g, 3), carry(g, 6);
  carry.clear(g.columns);
  for (int r = 0; r < g.rows; ++r) {
    const std::ptrdiff_t row = r * g.stride;
    const auto row_parity = hn::Set(d, static_cast<Real>(r % 2));
    const auto below = hn::Set(d, r + 1 < g.rows ? Real(1) : Real(0));
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const std::ptrdiff_t at = row + c, under = at + g.stride;
      const auto a = load(d, g.x, at), b = load(d, g.x, at + 1), e = load(d, g.x, under + 1),
                 f = load(d, g.x, under);
      const auto sa = load(d, g.slip, at), sb = load(d, g.slip, at + 1),
                 se = load(d, g.slip, under + 1), sf = load(d, g.slip, under);
      // Even cells are cut from a to e, odd ones from b to f (split_cells in cloth_model.cpp).
      const auto even = hn::Eq(hn::LoadU(d, g.odd + c), row_parity);
      const auto exists = hn::Mul(below, hn::LoadU(d, g.cell + c));
      const auto first = air_third(d, pressure, skin, a, b, select(even, e, f),
                                   (sa + sb) + select(even, se, sf)) * exists;
      const auto second = air_third(d, pressure, skin, select(even, a, b), e, f,
                                    (select(even, sa, sb) + se) + sf) * exists;
      on_a.store(d, c, first + keep_if(even, second));
      on_b.store(d, c, first + keep_if(hn::Not(even), second));
      on_e.store(d, c, second + keep_if(even, first));
      on_d.store(d, c, second + keep_if(hn::Not(even), first));
    }
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const auto total = carry.load(d, c) + (on_a.load(d, c) + on_b.load(d, c - 1));
      carry.store(d, c, on_d.load(d, c) + on_e.load(d, c - 1));
      store_particles(d, total, g.columns - c, force + 3 * (static_cast<std::ptrdiff_t>(r) * g.columns + c));
    }
  }
}

HWY_ATTR void internal_forces_f32(const GridView<float>& grid, float* force) {
  internal_forces(grid, force);
}
HWY_ATTR void internal_forces_f64(const GridView<double>& grid, double* force) {
  internal_forces(grid, force);
}
HWY_ATTR void air_forces_f32(const GridView<float>& grid, float pressure, float skin, float* force) {
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
