// Compiles the transfers for each instruction set and dispatches to them.

#include "core/solver/implicit/grid_transfer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/implicit/grid_transfer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/implicit/grid_transfer-inl.h"

#if HWY_ONCE
namespace weft {

HWY_EXPORT(restrict_f32);
HWY_EXPORT(restrict_f64);
HWY_EXPORT(prolong_f32);
HWY_EXPORT(prolong_f64);
HWY_EXPORT(coarsen_f32);
HWY_EXPORT(coarsen_f64);

void restrict_plane(const GridLayout& fine, const GridLayout& coarse, const float* from, float* to,
                    TransferLines<float>& lines) {
  HWY_DYNAMIC_DISPATCH(restrict_f32)(fine, coarse, from, to, lines);
}
void add_prolonged(const GridLayout& fine, const GridLayout& coarse, const float* free,
                   const float* from, float* to, TransferLines<float>& lines) {
  HWY_DYNAMIC_DISPATCH(prolong_f32)(fine, coarse, free, from, to, lines);
}
void coarsen_springs(const SpringGrid<float>& fine, SpringGrid<float>& coarse,
                     TransferLines<float>& lines) {
  HWY_DYNAMIC_DISPATCH(coarsen_f32)(fine, coarse, lines);
}

void restrict_plane(const GridLayout& fine, const GridLayout& coarse, const double* from,
                    double* to, TransferLines<double>& lines) {
  HWY_DYNAMIC_DISPATCH(restrict_f64)(fine, coarse, from, to, lines);
}
void add_prolonged(const GridLayout& fine, const GridLayout& coarse, const double* free,
                   const double* from, double* to, TransferLines<double>& lines) {
  HWY_DYNAMIC_DISPATCH(prolong_f64)(fine, coarse, free, from, to, lines);
}
void coarsen_springs(const SpringGrid<double>& fine, SpringGrid<double>& coarse,
                     TransferLines<double>& lines) {
  HWY_DYNAMIC_DISPATCH(coarsen_f64)(fine, coarse, lines);
}

template <class Real>
void TransferLines<Real>::prepare(const GridLayout& finest) {
  // A margin in front; behind, the double width of vectors of coarse columns.
  for (AlignedVector<Real>* line : {&fine, &coarse})
    line->assign(static_cast<std::size_t>(finest.stride + 5 * kGridMargin), Real(0));
}

template struct TransferLines<float>;
template struct TransferLines<double>;

}  // namespace weft
#endif
