#include "core/contact/travel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/travel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/travel-inl.h"

#if HWY_ONCE
namespace weft {

HWY_EXPORT(travel_f32);
HWY_EXPORT(travel_f64);
HWY_EXPORT(deviation_f32);
HWY_EXPORT(deviation_f64);

bool measure_travel(const TravelPass<float>& pass) {
  return HWY_DYNAMIC_DISPATCH(travel_f32)(pass);
}

bool measure_travel(const TravelPass<double>& pass) {
  return HWY_DYNAMIC_DISPATCH(travel_f64)(pass);
}

float largest_deviation(const PathPass<float>& pass) {
  return HWY_DYNAMIC_DISPATCH(deviation_f32)(pass);
}

double largest_deviation(const PathPass<double>& pass) {
  return HWY_DYNAMIC_DISPATCH(deviation_f64)(pass);
}

}  // namespace weft
#endif
