// Builds and refits the trees for pictures of boxes.

#include "core/world/debug_trees.h"

#include <algorithm>
#include <cassert>

#include "core/error.h"

namespace weft {

template <class Real>
DebugTrees<Real>::DebugTrees(const ClothModel<Real>& model,
                             const std::vector<ColliderDef>& colliders)
    : edges_(model.edges), triangles_(model.triangles) {
  cloth_.build(model.rest_positions, edges_, triangles_);
  for (const ColliderDef& collider : colliders) {
    const auto* shape = std::get_if<MeshDef>(&collider.shape);
    if (!shape) continue;
    std::vector<Aabb<Real>> boxes;
    for (const Triangle& t : shape->mesh.triangles) {
      Aabb<Real> box;
      for (const Index v : t)
        box.add(shape->mesh.positions[static_cast<std::size_t>(v)].template cast<Real>().eval());
      boxes.push_back(box);
    }
    objects_.emplace_back("object:" + collider.name, BottomUpTree<Real>{});
    objects_.back().second.build(boxes, pairs_that_touch(shape->mesh.triangles));
  }
}

template <class Real>
std::vector<std::string> DebugTrees<Real>::names() const {
  std::vector<std::string> names = {"particles", "edges", "triangles"};
  for (const auto& object : objects_) names.push_back(object.first);
  return names;
}

template <class Real>
const BottomUpTree<Real>* DebugTrees<Real>::object(const std::string& tree) const {
  for (const auto& [name, found] : objects_)
    if (name == tree) return &found;
  return nullptr;
}

template <class Real>
int DebugTrees<Real>::level_count(const std::string& tree) const {
  if (tree == "particles") return cloth_.particle_levels();
  if (tree == "edges") return cloth_.edge_levels();
  if (tree == "triangles") return cloth_.triangle_levels();
  if (const BottomUpTree<Real>* found = object(tree)) return found->level_count();
  std::string all;
  for (const std::string& name : names()) all += (all.empty() ? "" : ", ") + name;
  throw DefinitionError("tree", tree, "one of " + all);
}

template <class Real>
std::vector<Aabb<float>> DebugTrees<Real>::boxes(const std::string& tree, int level,
                                                 const Vec3Array<Real>& x) {
  if (level < 0)
    throw DefinitionError("level", std::to_string(level), "0 or more", "0 is the root");
  const int shown = std::min(level, level_count(tree) - 1);
  if (tree == "particles") return boxes_of_level(cloth_.particles(x, Real(0)), shown);
  if (tree == "edges") return boxes_of_level(cloth_.edges(x, edges_, Real(0)), shown);
  if (tree == "triangles") return boxes_of_level(cloth_.triangles(x, triangles_, Real(0)), shown);
  assert(object(tree) && "level_count knows no other tree");
  return boxes_of_level(*object(tree), shown);
}

template class DebugTrees<float>;
template class DebugTrees<double>;

}  // namespace weft
