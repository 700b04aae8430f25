#include "core/contact/objects/feature_distance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/objects/feature_distance.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/objects/feature_distance-inl.h"

#if HWY_ONCE
namespace weft {

#define WEFT_EXPORT(name)                                         \
  HWY_EXPORT(name##_f32);                                         \
  HWY_EXPORT(name##_f64);                                         \
  std::size_t measure_##name(const FeatureTable<float>& table) {  \
    return HWY_DYNAMIC_DISPATCH(name##_f32)(table);               \
  }                                                               \
  std::size_t measure_##name(const FeatureTable<double>& table) { \
    return HWY_DYNAMIC_DISPATCH(name##_f64)(table);               \
  }
WEFT_EXPORT(segments)
WEFT_EXPORT(points_from_triangles)
WEFT_EXPORT(triangles_from_points)
#undef WEFT_EXPORT

HWY_EXPORT(complete_triangles_f32);
HWY_EXPORT(complete_triangles_f64);

void prepare_triangles(std::size_t blocks, float* values) {
  HWY_DYNAMIC_DISPATCH(complete_triangles_f32)(blocks, values);
}
void prepare_triangles(std::size_t blocks, double* values) {
  HWY_DYNAMIC_DISPATCH(complete_triangles_f64)(blocks, values);
}

}  // namespace weft
#endif
