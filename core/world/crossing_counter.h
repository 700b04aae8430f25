#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/diagnostics/crossings.h"
#include "core/world/world.h"

namespace weft {

/// Counts in one world, again and again, what should never be: edges of cloths through triangles of
/// cloths, and of cloths and objects through each other. Objects without triangles (planes,
/// spheres, capsules) are left to World::deepest_penetration. Keeps what it needs, so that nothing
/// is allocated from the second count on.
template <class Real>
class CrossingCounter {
 public:
  /// Of the present state.
  /// @param world  always the same one
  Crossings count(const World<Real>& world);

 private:
  /// An object with triangles, where it was last.
  struct Object {
    std::size_t collider = 0;
    TriangleMesh mesh;  ///< as defined
    CrossingSurface surface;
    std::optional<Pose> pose;
  };

  void list_surfaces(const World<Real>& world);

  std::optional<CrossingSurface> cloth_;
  std::vector<Object> objects_;
};

/// Smallest distance between features that the world's contact holds apart now, or is about to [m];
/// negative inside an object that it shall leave, infinity if nothing is near, or where the contact
/// does not tell (that of the seed).
template <class Real>
double smallest_gap(const World<Real>& world);

extern template class CrossingCounter<float>;
extern template class CrossingCounter<double>;

}  // namespace weft
