#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

#include "core/cloth/edge_sides.h"
#include "core/cloth/field_fit.h"
#include "core/cloth/neighbours.h"
#include "core/cloth/unfolding.h"
#include "core/types.h"

// Slope of a field across the edges of a mesh, from its values at the particles.

namespace weft {

/// A particle's share in a linear function of a field.
struct ParticleWeight {
  Index particle = kNone;
  double weight = 0;
};

/// Adds to the particle's weight in a short list.
void add_weight(Index particle, double weight, std::vector<ParticleWeight>& list);

/// Finds the slopes across the edges of a mesh. The mean of the slopes in both triangles, weighted
/// by their heights, is exact for quadratic fields where the triangles make a parallelogram.
/// Elsewhere, and on the border, the least change of weights within the triangles' surroundings
/// makes it so.
///
/// A triangle much lower than its surroundings is a needle. Its own slope, and the jump between the
/// slopes across its long edges, are differences of its particles over its height, so their weights
/// grow as it gets lower. So the long edges of a needle, and those of needles that share one, have
/// the slopes of one quadratic field, the least-squares fit around them all. A needle then bends
/// like its surroundings, and its weights stay bounded. An edge with large weights of its own has
/// the slope of a least-squares fit too.
class EdgeSlopes {
 public:
  /// @param x       of the particles of a mesh whose triangles are flat together wherever they
  ///                meet [m]
  /// @param shapes  of its triangles, if they are not: what lies around an edge is then unfolded
  ///                into its plane, and x is not read; else null
  EdgeSlopes(const Vec3Array<double>& x, const std::vector<Triangle>& triangles,
             const FlatShapes* shapes);

  const std::vector<EdgeSides>& edges() const { return edges_; }

  /// The edges of a triangle, opposite to each corner.
  const std::array<Index, 3>& edges_of(std::size_t triangle) const {
    assert(triangle < of_.size());
    return of_[triangle];
  }

  /// Weights that give the slope at the middle of the edge in its plane and at right angles to it,
  /// into its first triangle [1/m]. They are exact for linear fields, and for quadratic ones as far
  /// as the mesh around the edge distinguishes them.
  /// @param edge  number of it
  std::vector<ParticleWeight> across(std::size_t edge) const;

  /// Whether these slopes go into one of the edge's triangles, 0 or 1, and not out of it: into the
  /// first, unless rounding has turned one over.
  bool goes_into(std::size_t edge, std::size_t side) const;

  /// The mean slope across an edge beside a clamp, in the same sense: exact for the field whose
  /// only curvature is across the clamp's border and which is zero and level up to that.
  /// @param beyond  distance of each particle beyond the border, negative where it is held
  std::vector<ParticleWeight> across_clamped(const EdgeSides& edge,
                                             const std::vector<double>& beyond) const;

  /// Whether a particle that an edge's slope may use is held behind a border.
  bool meets_held(const EdgeSides& edge, const std::vector<double>& beyond) const;

  /// The slope in one of an edge's triangles, 0 or 1, which is that of a linear field.
  std::vector<ParticleWeight> inside(const EdgeSides& edge, std::size_t side) const;

 private:
  struct Frame;
  using Members = std::vector<Index>;

  Frame frame_of(const EdgeSides& edge) const;
  Frame unfolded_frame(const EdgeSides& edge) const;
  Eigen::Vector2d laid_out(Index particle, const Frame& frame) const;
  Eigen::Vector2d place_of(Index particle, const Frame& frame) const;
  Members nearest(const EdgeSides& edge) const;
  Members grown(const Members& members) const;
  double spread(const Members& members, const Frame& frame) const;
  void add_inside(const EdgeSides& edge, const Frame& frame, std::size_t side, double share,
                  std::vector<ParticleWeight>& slope) const;
  std::vector<ParticleWeight> mean_inside(const EdgeSides& edge, const Frame& frame) const;
  template <int Fields, class ValueAt>
  FieldFit<Fields> fit_around(Frame& frame, const ValueAt& value, Members& members) const;
  template <int Fields, class ValueAt>
  void amend(const EdgeSides& edge, Frame& frame, const ValueAt& value,
             const Eigen::Matrix<double, Fields, 1>& wanted,
             std::vector<ParticleWeight>& slope) const;
  std::vector<ParticleWeight> across_best_fit(std::size_t number,
                                              const std::vector<Index>& edges) const;
  double lowness(std::size_t number, Index triangle) const;
  void find_needles();

  const Vec3Array<double>& x_;
  std::vector<EdgeSides> edges_;
  std::vector<std::array<Index, 3>> of_;  // edges of each triangle
  Neighbours neighbours_;
  const FlatShapes* shapes_;
  std::vector<std::vector<Index>> needles_;  // long edges of each, or of several that share some
  std::vector<Index> needle_of_;             // of each edge; else none
};

}  // namespace weft
