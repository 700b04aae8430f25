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

namespace weft {

HWY_EXPORT(spread_f32);
HWY_EXPORT(spread_f64);
HWY_EXPORT(spread_ones_f32);
HWY_EXPORT(spread_ones_f64);

bool is_spread(const SpreadPass<float>& pass) {
  assert(pass.x && pass.falls && pass.rows > 0 && pass.columns > 0);
  return HWY_DYNAMIC_DISPATCH(spread_f32)(pass);
}

bool is_spread(const SpreadPass<double>& pass) {
  assert(pass.x && pass.falls && pass.rows > 0 && pass.columns > 0);
  return HWY_DYNAMIC_DISPATCH(spread_f64)(pass);
}

std::uint64_t spread_cells(const SpreadPass<float>& pass) {
  assert(pass.x && pass.falls && pass.rows > 0 && pass.columns > 0);
  assert(std::max(pass.rows, pass.columns) <= kMostSpreadCells);
  return HWY_DYNAMIC_DISPATCH(spread_ones_f32)(pass);
}

std::uint64_t spread_cells(const SpreadPass<double>& pass) {
  assert(pass.x && pass.falls && pass.rows > 0 && pass.columns > 0);
  assert(std::max(pass.rows, pass.columns) <= kMostSpreadCells);
  return HWY_DYNAMIC_DISPATCH(spread_ones_f64)(pass);
}

}  // namespace weft
#endif
