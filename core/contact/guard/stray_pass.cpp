// Compiles the look for strays for each instruction set and dispatches to it.

#include "core/contact/guard/stray_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/guard/stray_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/contact/guard/stray_pass-inl.h"

#if HWY_ONCE
#include <cassert>

namespace weft {

HWY_EXPORT(look_f32);
HWY_EXPORT(look_f64);

StrayLook<float> look_for_strays(const StrayPass<float>& pass, std::size_t first, std::size_t end,
                                 std::vector<Index>& strays) {
  assert(first <= end && pass.soon2 <= pass.limit2);
  return HWY_DYNAMIC_DISPATCH(look_f32)(pass, first, end, strays);
}

StrayLook<double> look_for_strays(const StrayPass<double>& pass, std::size_t first, std::size_t end,
                                  std::vector<Index>& strays) {
  assert(first <= end && pass.soon2 <= pass.limit2);
  return HWY_DYNAMIC_DISPATCH(look_f64)(pass, first, end, strays);
}

}  // namespace weft
#endif
