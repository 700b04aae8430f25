#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/diagnostics/crossings.h"
#include "core/world/world.h"

namespace weft {

/// What crosses in a world: edges through triangles, exactly.
struct WorldCrossings {
  Crossings cloths;   ///< of the cloths with themselves and each other
  Crossings objects;  ///< with boxes and meshes, and of triangles with the axes of rods

  /// All of them, those that only touch too.
  std::size_t total() const { return cloths.all() + objects.all(); }
};

/// Counts in one world, again and again, what should never be: edges of cloths through triangles of
/// cloths, of cloths and objects through each other, and axes of rods through cloths. Planes and
/// balls have neither edges nor axes: how deep cloth is in those World::deepest_penetration tells.
/// Keeps what it needs, so that nothing is allocated from the second count on.
template <class Real>
class CrossingCounter {
 public:
  /// Of the present state, with objects where they are now.
  /// @param world  always the same one; its positions finite
  /// @param meetings  gets who crosses whom; may be null
  WorldCrossings count(const World<Real>& world, std::vector<Meeting>* meetings = nullptr);

  /// Adds triangles in balls and rods, which have no edges to cross, after a count of the same
  /// state.
  void find_in_rounds(const World<Real>& world, std::vector<Meeting>& meetings) const;

 private:
  /// An object with triangles or an axis, where it was last.
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

/// Adds to what nothing is promised about those that meet although contact promises that they do
/// not, unless they are there already.
/// @param verb   "started through" or "passes through"
/// @param known  what was told before: who is there as inside an object stays so
template <class Real>
void add_meetings(const World<Real>& world, const std::vector<Meeting>& meetings,
                  const std::string& verb, const std::vector<std::string>& known, BadStarts& to);

/// Smallest distance between features that the world's contact holds apart now, or is about to [m];
/// negative inside an object that it shall leave, infinity if nothing is near, or where the contact
/// does not tell (that of the seed).
template <class Real>
double smallest_gap(const World<Real>& world);

extern template class CrossingCounter<float>;
extern template class CrossingCounter<double>;

}  // namespace weft
