// The misfit of a grid's cells in vector code; see cell_misfit.h.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_MISFIT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_MISFIT_INL_H
#undef WEFT_GRID_MISFIT_INL_H
#else
#define WEFT_GRID_MISFIT_INL_H
#endif

#include "core/forces/grid_layout-inl.h"
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// g of the cells from (r, c) on, and dg/dw.
template <class D>
struct Misfits {
  hn::Vec<D> g, slope;

  /// @param x  positions at (r, c)
  template <class Real>
  HWY_INLINE Misfits(D d, const GridView<Real>& view, const Real* x) {
    const auto one = hn::Set(d, Real(1)), growth = hn::Set(d, view.misfit.growth);
    const auto twist =
        (load(d, x + view.pitch() + 1, view.line) - load(d, x + view.pitch(), view.line)) -
        (load(d, x + 1, view.line) - load(d, x, view.line));
    const auto w = hn::Mul(fused_dot(d, twist, twist), hn::Set(d, view.misfit.per_d2));
    const auto eighth = hn::Mul(hn::Set(d, Real(0.125)), w), w2 = hn::Mul(w, w);
    const auto per = hn::Div(one, fused(d, w2, w2, one));
    g = hn::Mul(fused(d, hn::Add(growth, eighth), w2, w), per);
    // 1 + 2 s w + 3 w^2/8 - 4 g w^3
    const auto rise =
        hn::Add(hn::Add(growth, growth), fused(d, eighth, hn::Set(d, Real(2)), eighth));
    const auto fall = hn::Mul(hn::Mul(hn::Set(d, Real(4)), g), w2);
    slope = hn::Mul(fused(d, hn::Sub(rise, fall), w, one), per);
  }
};

/// Stiffness of the twist of a row's cells: that of bending less `misfit_softening`.
template <class Real>
HWY_INLINE void compute_twist_stiffness(const GridView<Real>& g, std::ptrdiff_t r, Real* to) {
  using D = GridTag<Real>;
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const Real* const x = g.motion + r * g.pitch();
  const Real* const bending = g.row[r].coefficients + kTwist * g.line;
  const Real* const present = g.row[r].coefficients + kHasCell * g.line;
  const auto most = hn::Set(d, 2 * g.misfit.stiffness * g.misfit.per_d2);
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
    const Misfits<D> at(d, g, x + c);
    const auto softening = hn::Mul(most, hn::Mul(at.g, at.slope));
    hn::StoreU(fused_minus(d, softening, hn::LoadU(d, present + c), hn::LoadU(d, bending + c)), d,
               to + c);
  }
}

/// `doubled_misfit_energy` of the cells from (r, c) on.
/// @param x, present  at (r, c)
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> doubled_misfit(D d, const GridView<Real>& g, const Real* x,
                                     const Real* present) {
  const Misfits<D> at(d, g, x);
  return hn::Mul(hn::Mul(hn::Set(d, g.misfit.stiffness), hn::LoadU(d, present)),
                 hn::Mul(at.g, at.g));
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
