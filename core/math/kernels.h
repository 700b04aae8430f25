#pragma once

#include <type_traits>

#include <hwy/highway.h>

// How vector code in both precisions is chosen for the processor when the program runs.

/// For one instruction set: the kernel template `name` in both precisions.
#define WEFT_KERNEL(name)                          \
  static constexpr auto& name##_f32 = name<float>; \
  static constexpr auto& name##_f64 = name<double>

/// Lists it for all instruction sets, so that WEFT_RUN(name, Real) is the one for this processor.
#define WEFT_EXPORT_KERNEL(name) \
  HWY_EXPORT(name##_f32);        \
  HWY_EXPORT(name##_f64)
#define WEFT_RUN(name, Real)                                                   \
  (::weft::of_precision<Real>([] { return HWY_DYNAMIC_DISPATCH(name##_f32); }, \
                              [] { return HWY_DYNAMIC_DISPATCH(name##_f64); }))

namespace weft {

template <class Real>
auto of_precision(auto&& of_float, auto&& of_double) {
  if constexpr (std::is_same_v<Real, float>)
    return of_float();
  else
    return of_double();
}

}  // namespace weft
