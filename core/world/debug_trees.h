#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/contact/colliders/collider.h"
#include "core/geometry/bottom_up_tree.h"
#include "core/geometry/cloth_trees.h"

// Box hierarchies of a world, for pictures.

namespace weft {

/// The seed's trees over a world, for any contact model, for pictures of their boxes: "particles",
/// "edges" and "triangles" of all cloths, and "object:<name>" over the triangles of each mesh
/// collider.
template <class Real>
class DebugTrees {
 public:
  DebugTrees(const ClothModel<Real>& model, const std::vector<ColliderDef>& colliders);

  /// Names of all trees.
  std::vector<std::string> names() const;

  /// Boxes of one level of a tree around the cloth at x; level 0 is one box around everything, and
  /// levels below the last give the last. Throws DefinitionError, with the names, if there is no
  /// such tree, and if the level is negative.
  std::vector<Aabb<float>> boxes(const std::string& tree, int level, const Vec3Array<Real>& x);

  /// Number of levels of a tree, at least 1. Throws as `boxes` does.
  int level_count(const std::string& tree) const;

 private:
  const BottomUpTree<Real>* object(const std::string& tree) const;

  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  ClothTrees<Real> cloth_;
  std::vector<std::pair<std::string, BottomUpTree<Real>>> objects_;
};

extern template class DebugTrees<float>;
extern template class DebugTrees<double>;

}  // namespace weft
