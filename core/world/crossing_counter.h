#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/diagnostics/crossings.h"
#include "core/world/world.h"

// Exact count of crossings in a world.

namespace weft {

/// Crossings in a world: edges through triangles, exactly.
struct WorldCrossings {
  Crossings cloths;   ///< of the cloths with themselves and each other
  Crossings objects;  ///< with boxes and meshes, and of triangles with the axes of capsules

  /// All of them, including those that only touch.
  std::size_t total() const { return cloths.all() + objects.all(); }
};

/// Counts crossings in one world repeatedly: edges of cloths through triangles of cloths, of cloths
/// and objects through each other, and axes of capsules through cloths. Planes and balls have
/// neither edges nor axes: World::deepest_penetration tells how deep cloth is in those. It keeps
/// its arrays, so that nothing is allocated from the second count on.
template <class Real>
class CrossingCounter {
 public:
  /// Counts in the present state, with objects at their present poses.
  /// @param world  always the same one; its positions finite
  /// @param meetings  receives which pairs cross; may be null
  WorldCrossings count(const World<Real>& world, std::vector<Meeting>* meetings = nullptr);

  /// Adds triangles inside balls and capsules, which have no edges to cross, after a count of the
  /// same state.
  void find_in_rounds(const World<Real>& world, std::vector<Meeting>& meetings) const;

 private:
  /// An object with triangles or an axis, at its last pose.
  struct Object {
    std::size_t collider = 0;
    std::vector<Vec3d> own;  ///< its vertices as defined [m]
    CrossingSurface surface;
    std::optional<Pose> pose;
  };

  void list_surfaces(const World<Real>& world);

  std::optional<CrossingSurface> cloth_;
  std::vector<Object> objects_;
};

/// Adds meetings that contact promises to prevent, unless they are already known, to the bad
/// starts.
/// @param verb   "started through" or "passes through"
/// @param known  earlier announcements: pairs announced as inside an object stay so
template <class Real>
void add_meetings(const World<Real>& world, const std::vector<Meeting>& meetings,
                  const std::string& verb, const std::vector<std::string>& known, BadStarts& to);

/// Smallest distance between features that the world's contact separates now or is about to [m];
/// negative inside an object that the cloth is to leave, infinity if nothing is near or the contact
/// model does not measure it (the seed's).
template <class Real>
double smallest_gap(const World<Real>& world);

extern template class CrossingCounter<float>;
extern template class CrossingCounter<double>;

}  // namespace weft
