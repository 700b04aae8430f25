// Compiles the test of a rectangle for each instruction set and dispatches to it.

#include "core/contact/guard/spread_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/guard/spread_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/contact/guard/spread_pass-inl.h"

#if HWY_ONCE
#include <algorithm>
#include <cassert>

#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(spread);
WEFT_EXPORT_KERNEL(spread_ones);

template <class Real>
bool is_spread(const SpreadPass<Real>& pass) {
  assert(pass.x && pass.falls && pass.rows > 0 && pass.columns > 0);
  return WEFT_RUN(spread, Real)(pass);
}

template <class Real>
std::uint64_t spread_cells(const SpreadPass<Real>& pass) {
  assert(pass.x && pass.falls && pass.rows > 0 && pass.columns > 0);
  assert(std::max(pass.rows, pass.columns) <= kMostSpreadCells);
  return WEFT_RUN(spread_ones, Real)(pass);
}

WEFT_INSTANTIATE_FUNCTIONS(is_spread, spread_cells)

}  // namespace weft
#endif
