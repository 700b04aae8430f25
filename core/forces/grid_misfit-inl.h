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

/// p of the cells from (r, c) on, with their w as far as it counts, and the whole of it.
template <class D>
struct Misfits {
  hn::Vec<D> whole, w, p;

  /// @param x  positions at (r, c)
  template <class Real>
  HWY_INLINE Misfits(D d, const GridView<Real>& view, const Real* x) {
    const MisfitLaw<Real>& law = view.misfit;
    const auto twist =
        (load(d, x + view.pitch() + 1, view.line) - load(d, x + view.pitch(), view.line)) -
        (load(d, x + 1, view.line) - load(d, x, view.line));
    whole = hn::Mul(fused_dot(d, twist, twist), hn::Set(d, law.per_d2));
    w = hn::Min(whole, hn::Set(d, Real(kMisfitEnd)));
    const auto rise = fused(d, w, hn::Set(d, law.fourth), hn::Set(d, law.third));
    p = fused(d, hn::Mul(w, w), fused(d, w, rise, hn::Set(d, law.second)), w);
  }
};

/// Stiffness of the twist of a row's cells: that of bending less `misfit_softening`.
template <class Real>
HWY_INLINE void soften_twist(const GridView<Real>& g, std::ptrdiff_t r, Real* to) {
  using D = GridTag<Real>;
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const Real* const x = g.motion + r * g.pitch();
  const Real* const bending = g.row[r].coefficients + kTwist * g.line;
  const Real* const present = g.row[r].coefficients + kHasCell * g.line;
  const auto most = hn::Set(d, 2 * g.misfit.stiffness * g.misfit.per_d2);
  for (std::ptrdiff_t c = 0; c < g.columns; c += lanes) {
    const Misfits<D> at(d, g, x + c);
    const auto softening = hn::Mul(most, at.p);
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
  const MisfitLaw<Real>& law = g.misfit;
  const auto fourth = hn::Set(d, law.fourth / Real(2.5)), third = hn::Set(d, law.third / 2),
             second = hn::Set(d, law.second / Real(1.5));
  const auto rising =
      fused(d, at.w, fused(d, at.w, fused(d, at.w, fourth, third), second), hn::Set(d, Real(1)));
  const auto level = hn::Mul(hn::Add(at.p, at.p), hn::Sub(at.whole, at.w));
  return hn::Mul(hn::Mul(hn::Set(d, law.stiffness), hn::LoadU(d, present)),
                 fused(d, hn::Mul(at.w, at.w), rising, level));
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
