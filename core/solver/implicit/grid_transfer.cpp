// Compiles the transfers for each instruction set and dispatches to them.

#include "core/solver/implicit/grid_transfer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/implicit/grid_transfer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/implicit/grid_transfer-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(restrict_rows);
WEFT_EXPORT_KERNEL(prolong_rows);
WEFT_EXPORT_KERNEL(coarsen_grid);

template <class Real>
void restrict_plane(const GridLayout& fine, const GridLayout& coarse, const Real* from, Real* to,
                    TransferLines<Real>& lines) {
  WEFT_RUN(restrict_rows, Real)(fine, coarse, from, to, lines);
}

template <class Real>
void add_prolonged(const GridLayout& fine, const GridLayout& coarse, const Real* free,
                   const Real* from, Real* to, TransferLines<Real>& lines) {
  WEFT_RUN(prolong_rows, Real)(fine, coarse, free, from, to, lines);
}

template <class Real>
void coarsen_springs(const SpringGrid<Real>& fine, SpringGrid<Real>& coarse,
                     TransferLines<Real>& lines) {
  WEFT_RUN(coarsen_grid, Real)(fine, coarse, lines);
}

template <class Real>
void TransferLines<Real>::prepare(const GridLayout& finest) {
  // A margin in front; behind, the double width of vectors of coarse columns.
  for (AlignedVector<Real>* line : {&fine, &coarse})
    line->assign(static_cast<std::size_t>(finest.stride + 5 * kGridMargin), Real(0));
}

WEFT_INSTANTIATE_FUNCTIONS(restrict_plane, add_prolonged, coarsen_springs)
template struct TransferLines<float>;
template struct TransferLines<double>;

}  // namespace weft
#endif
