#include "core/contact/objects/feature_distance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/objects/feature_distance.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/objects/feature_distance-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(segments);
WEFT_EXPORT_KERNEL(points_from_triangles);
WEFT_EXPORT_KERNEL(triangles_from_points);
WEFT_EXPORT_KERNEL(complete_triangles);

template <class Real>
std::size_t measure_segments(const FeatureTable<Real>& table) {
  return WEFT_RUN(segments, Real)(table);
}

template <class Real>
std::size_t measure_points_from_triangles(const FeatureTable<Real>& table) {
  return WEFT_RUN(points_from_triangles, Real)(table);
}

template <class Real>
std::size_t measure_triangles_from_points(const FeatureTable<Real>& table) {
  return WEFT_RUN(triangles_from_points, Real)(table);
}

template <class Real>
void prepare_triangles(std::size_t blocks, Real* values) {
  WEFT_RUN(complete_triangles, Real)(blocks, values);
}

WEFT_INSTANTIATE_FUNCTIONS(measure_segments, measure_points_from_triangles,
                           measure_triangles_from_points, prepare_triangles)

}  // namespace weft
#endif
