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

#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(look);

template <class Real>
StrayLook<Real> look_for_strays(const StrayPass<Real>& pass, std::size_t first, std::size_t end,
                                std::vector<Index>& strays) {
  assert(first <= end && pass.soon2 <= pass.limit2);
  return WEFT_RUN(look, Real)(pass, first, end, strays);
}

WEFT_INSTANTIATE_FUNCTIONS(look_for_strays)

}  // namespace weft
#endif
