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

/// w of the cells from (r, c) on, as far as it counts.
/// @param x  positions at (r, c)
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> misfits(D d, const GridView<Real>& g, const Real* x) {
  const auto twist = (load(d, x + g.pitch() + 1, g.line) - load(d, x + g.pitch(), g.line)) -
                     (load(d, x + 1, g.line) - load(d, x, g.line));
  return hn::Min(hn::Mul(fused_dot(d, twist, twist), hn::Set(d, g.misfit.per_d2)),
                 hn::Set(d, Real(kMisfitEnd)));
}

/// 1 + w (a + w (b + w c)).
template <class D, class V = hn::Vec<D>, class Real = hn::TFromD<D>>
HWY_INLINE V cubic(D d, V w, Real a, Real b, Real c) {
  const V upper = fused(d, w, hn::Set(d, c), hn::Set(d, b));
  return fused(d, w, fused(d, w, upper, hn::Set(d, a)), hn::Set(d, Real(1)));
}

/// Twice the integral of p, over w^2.
template <class D, class V = hn::Vec<D>, class Real = hn::TFromD<D>>
HWY_INLINE V mean_rise(D d, V w, const MisfitLaw<Real>& law) {
  return cubic(d, w, law.second / Real(1.5), law.third / 2, law.fourth / Real(2.5));
}

/// Stiffness of the twist of a row's cells: that of bending less `misfit_softening`.
template <class Real>
HWY_INLINE void soften_twist(const GridView<Real>& g, std::ptrdiff_t r, Real* to) {
  using D = GridTag<Real>;
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const Real* const x = g.motion + r * g.pitch();
  const Real* const bending = g.row[r].coefficients + kTwist * g.line;
  const Real* const present = g.row[r].coefficients + kHasCell * g.line;
  const MisfitLaw<Real>& law = g.misfit;
  const auto most = hn::Set(d, 2 * law.stiffness * law.per_d2);
  const auto one = hn::Set(d, Real(1)), per = hn::Set(d, Real(kMisfitFall)),
             four = hn::Set(d, Real(4 * kMisfitFall));
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
    const auto w = misfits(d, g, x + c), w2 = hn::Mul(w, w), w3 = hn::Mul(w2, w);
    const auto fade = fused_minus(d, hn::Mul(w2, w2), per, one);
    const auto p = hn::Mul(w, cubic(d, w, law.second, law.third, law.fourth));
    const auto steep = hn::Mul(hn::Mul(w3, four), hn::Mul(w2, mean_rise(d, w, law)));
    const auto softening = hn::Mul(hn::Mul(most, fade), hn::Sub(hn::Mul(p, fade), steep));
    hn::StoreU(fused_minus(d, softening, hn::LoadU(d, present + c), hn::LoadU(d, bending + c)), d,
               to + c);
  }
}

/// `doubled_misfit_energy` of the cells from (r, c) on.
/// @param x, present  at (r, c)
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> doubled_misfit(D d, const GridView<Real>& g, const Real* x,
                                     const Real* present) {
  const MisfitLaw<Real>& law = g.misfit;
  const auto w = misfits(d, g, x), w2 = hn::Mul(w, w);
  const auto fade =
      fused_minus(d, hn::Mul(w2, w2), hn::Set(d, Real(kMisfitFall)), hn::Set(d, Real(1)));
  return hn::Mul(hn::Mul(hn::Set(d, law.stiffness), hn::LoadU(d, present)),
                 hn::Mul(hn::Mul(w2, mean_rise(d, w, law)), hn::Mul(fade, fade)));
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
