#pragma once

#include <algorithm>
#include <vector>

#include "core/geometry/bottom_up_tree.h"
#include "core/types.h"

// Keeps one box hierarchy each for a model's particles, edges and triangles.

namespace weft {

/// The seed's trees over all cloths: of particles, edges and triangles. Each is grouped once, from
/// the rest positions, and refitted on request.
template <class Real>
class ClothTrees {
 public:
  /// @param rest  positions that determine the grouping [m]
  void build(const Vec3Array<Real>& rest, const std::vector<Edge>& edges,
             const std::vector<Triangle>& triangles) {
    boxes_.reserve(std::max({rest.size(), edges.size(), triangles.size()}));
    fit_particles(rest, Real(0));
    particles_.build(boxes_, edges);
    box_all(rest, edges, Real(0));
    edges_.build(boxes_, pairs_that_touch(edges));
    box_all(rest, triangles, Real(0));
    triangles_.build(boxes_, pairs_that_touch(triangles));
  }

  /// @param margin  by which boxes are grown on every side [m]
  const BottomUpTree<Real>& particles(const Vec3Array<Real>& x, Real margin) {
    fit_particles(x, margin);
    particles_.refit(boxes_);
    return particles_;
  }
  const BottomUpTree<Real>& edges(const Vec3Array<Real>& x, const std::vector<Edge>& edges,
                                  Real margin) {
    box_all(x, edges, margin);
    edges_.refit(boxes_);
    return edges_;
  }
  const BottomUpTree<Real>& triangles(const Vec3Array<Real>& x,
                                      const std::vector<Triangle>& triangles, Real margin) {
    box_all(x, triangles, margin);
    triangles_.refit(boxes_);
    return triangles_;
  }
  /// @param box  box(triangle) gives the box of a triangle
  template <class Box>
  const BottomUpTree<Real>& triangles_in(const std::vector<Triangle>& triangles, Box&& box) {
    boxes_.clear();
    for (const Triangle& t : triangles) boxes_.push_back(box(t));
    triangles_.refit(boxes_);
    return triangles_;
  }

  /// Number of levels of each tree.
  int particle_levels() const { return particles_.level_count(); }
  int edge_levels() const { return edges_.level_count(); }
  int triangle_levels() const { return triangles_.level_count(); }

 private:
  void fit_particles(const Vec3Array<Real>& x, Real margin) {
    boxes_.clear();
    for (const Vec3<Real>& p : x) {
      Aabb<Real> box;
      box.add(p);
      boxes_.push_back(box.grown(margin));
    }
  }
  template <class Primitive>
  void box_all(const Vec3Array<Real>& x, const std::vector<Primitive>& primitives, Real margin) {
    boxes_.clear();
    for (const Primitive& p : primitives) {
      Aabb<Real> box;
      for (const Index v : p) box.add(x[static_cast<std::size_t>(v)]);
      boxes_.push_back(box.grown(margin));
    }
  }

  BottomUpTree<Real> particles_, edges_, triangles_;
  std::vector<Aabb<Real>> boxes_;  ///< of the primitives, while a tree is refitted
};

}  // namespace weft
