// Elastic energies of a grid.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_ENERGY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_ENERGY_INL_H
#undef WEFT_GRID_ENERGY_INL_H
#else
#define WEFT_GRID_ENERGY_INL_H
#endif

#include "core/forces/force_pass.h"
#include "core/forces/grid_layout-inl.h"
#include "core/forces/grid_misfit-inl.h"
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Doubled energies and largest strain, accumulated per column.
template <class D>
struct ColumnSums {
  hn::Vec<D> stretch, bending, strain;

  HWY_INLINE void add_spring(D tag, hn::Vec<D> stiffness, hn::Vec<D> rest_length,
                             const Triple<hn::Vec<D>>& d) {
    const auto longer = hn::Sub(hn::Sqrt(fused_dot(tag, d, d)), rest_length);
    stretch = fused(tag, hn::Mul(stiffness, longer), longer, stretch);
    const auto strain_here =
        hn::IfThenZeroElse(hn::Eq(stiffness, hn::Zero(tag)), hn::Div(hn::Abs(longer), rest_length));
    strain = hn::IfThenElse(hn::Le(strain_here, strain), strain, strain_here);  // lets NaN through
  }
  HWY_INLINE void add_stencil(D tag, hn::Vec<D> stiffness, const Triple<hn::Vec<D>>& value) {
    bending = fused(tag, stiffness, fused_dot(tag, value, value), bending);
  }
};

/// Energies of springs and bending, and the largest strain, at the grid's positions.
template <class Real>
HWY_ATTR ElasticEnergy elastic_energy(const GridView<Real>& g) {
  using D = GridTag<Real>;
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const std::ptrdiff_t line = g.line, pitch = g.pitch();
  for (std::ptrdiff_t c = 0; c < 3 * line; c += lanes) hn::StoreU(hn::Zero(d), d, g.scratch + c);
  const auto warp = hn::Set(d, g.springs.rest_warp), weft = hn::Set(d, g.springs.rest_weft),
             shear = hn::Set(d, g.springs.rest_shear);
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
      const Real* const x = g.motion + r * pitch + c;
      const Real* const k = g.row[r].coefficients + c;
      Real* const sums = g.scratch + c;
      const auto x0 = load(d, x, line), xr = load(d, x + 1, line), xd = load(d, x + pitch, line),
                 xe = load(d, x + pitch + 1, line);
      const auto along = xr - x0, down = xd - x0;
      const auto k_shear = hn::LoadU(d, k + kShear * line);
      ColumnSums<D> at{hn::LoadU(d, sums), hn::LoadU(d, sums + line),
                       hn::LoadU(d, sums + 2 * line)};
      at.add_spring(d, hn::LoadU(d, k + kWarp * line), warp, along);
      at.add_spring(d, hn::LoadU(d, k + kWeft * line), weft, down);
      at.add_spring(d, k_shear, shear, xe - x0);
      at.add_spring(d, k_shear, shear, xd - xr);
      at.stretch = hn::Sub(at.stretch, doubled_misfit(d, g, x, k + kHasCell * line));
      at.add_stencil(d, hn::LoadU(d, k + kTwist * line), (xe - xd) - along);
      at.add_stencil(d, hn::LoadU(d, k + kBendU * line), (load(d, x + 2, line) - xr) - along);
      at.add_stencil(d, hn::LoadU(d, k + kBendV * line),
                     (load(d, x + 2 * pitch, line) - xd) - down);
      hn::StoreU(at.stretch, d, sums);
      hn::StoreU(at.bending, d, sums + line);
      hn::StoreU(at.strain, d, sums + 2 * line);
    }
  }
  ElasticEnergy energy;
  energy.stretch = 0.5 * sum_of_columns(g, g.scratch);
  energy.bending = 0.5 * sum_of_columns(g, g.scratch + line);
  for (std::ptrdiff_t c = 0; c < g.columns; ++c) {
    const auto strain = static_cast<double>(g.scratch[2 * line + c]);
    if (!(strain <= energy.largest_strain)) energy.largest_strain = strain;
  }
  return energy;
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
