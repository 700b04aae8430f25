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
template <class D, class V = hn::Vec<D>>
HWY_INLINE V cubic(D d, V w, V a, V b, V c) {
  return fused(d, w, fused(d, w, fused(d, w, c, b), a), hn::Set(d, hn::TFromD<D>(1)));
}

/// `misfit_softening` of cells, with its constants in registers.
template <class D>
struct MisfitSoftening {
  using V = hn::Vec<D>;
  using Real = hn::TFromD<D>;
  /// Powers of less count for nothing. As denormal numbers they would take the processor long, in
  /// all cells of cloth that hangs flat.
  static constexpr Real kSmallest = Real(1e-7);

  V most, one, per, four, smallest;
  V second, third, fourth, mean_second, mean_third, mean_fourth;  ///< see MisfitLaw

  HWY_INLINE MisfitSoftening(D d, const MisfitLaw<Real>& law)
      : most(hn::Set(d, 2 * law.stiffness * law.per_d2)), one(hn::Set(d, Real(1))),
        per(hn::Set(d, Real(kMisfitFall))), four(hn::Set(d, Real(4 * kMisfitFall))),
        smallest(hn::Set(d, kSmallest)), second(hn::Set(d, law.second)),
        third(hn::Set(d, law.third)), fourth(hn::Set(d, law.fourth)),
        mean_second(hn::Set(d, law.mean_second)), mean_third(hn::Set(d, law.mean_third)),
        mean_fourth(hn::Set(d, law.mean_fourth)) {}

  HWY_INLINE V operator()(D d, V w) const {
    const V v = hn::Max(w, smallest), v2 = hn::Mul(v, v), v3 = hn::Mul(v2, v);
    const V fade = fused_minus(d, hn::Mul(v2, v2), per, one);
    const V p = hn::Mul(w, cubic(d, w, second, third, fourth));
    const V mean_rise = cubic(d, w, mean_second, mean_third, mean_fourth);
    const V steep = hn::Mul(hn::Mul(v3, four), hn::Mul(v2, mean_rise));
    return hn::Mul(hn::Mul(most, fade), hn::Sub(hn::Mul(p, fade), steep));
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
  const MisfitSoftening<D> softening(d, g.misfit);
  const std::ptrdiff_t columns = g.columns;
  for (std::ptrdiff_t c = 0; c < columns; c += lanes) {
    const auto less = softening(d, misfits(d, g, x + c));
    hn::StoreU(fused_minus(d, less, hn::LoadU(d, present + c), hn::LoadU(d, bending + c)), d,
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
  return hn::Mul(
      hn::Mul(hn::Set(d, law.stiffness), hn::LoadU(d, present)),
      hn::Mul(hn::Mul(w2, cubic(d, w, hn::Set(d, law.mean_second), hn::Set(d, law.mean_third),
                                hn::Set(d, law.mean_fourth))),
              hn::Mul(fade, fade)));
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
