#pragma once

#include <array>
#include <vector>

#include "core/cloth/edge_sides.h"
#include "core/types.h"

// Surroundings of an edge, laid flat, in a mesh that is not flat as a whole.

namespace weft {

/// The triangles of a mesh, each laid flat on its own.
struct FlatShapes {
  std::vector<Triangle> triangles;
  std::vector<std::array<Eigen::Vector2d, 3>> corners;  ///< by triangle [m]
};

/// A triangle beside one of its edges [m].
struct BesideEdge {
  double length = 0;  ///< of the edge in this triangle
  double foot = 0;    ///< of the third corner along it, from the edge's first end
  double height = 0;  ///< of the third corner over it
};

/// @param side  of the edge, 0 or 1, where it has a triangle
BesideEdge beside(const FlatShapes& shapes, const EdgeSides& edge, std::size_t side);

/// Length of an edge: the mean where its triangles, sewn together, differ [m].
double length_of(const FlatShapes& shapes, const EdgeSides& edge);

/// Lays the triangles around an edge into its plane, each beside one that lies there already and
/// with its own shape, those nearest in number of steps first. A developable mesh keeps all its
/// lengths. Elsewhere a place depends on the path of triangles to it, by the cube of the distance,
/// and the shortest path counts.
class Unfolding {
 public:
  /// Lays out the edge, along the first axis with its middle at the origin, and the first of its
  /// triangles on the positive side of it, the other one on the negative.
  /// @param edges  of the mesh
  /// @param of     the edges of each triangle, opposite to its corners
  Unfolding(const EdgeSides& edge, const FlatShapes& shapes, const std::vector<EdgeSides>& edges,
            const std::vector<std::array<Index, 3>>& of);

  /// Lays out more triangles until these particles have a place, and removes those that have none
  /// after kMostUnfolded triangles.
  void lay_out(std::vector<Index>& particles);

  /// Of a particle [m]; null if it was not laid out.
  const Eigen::Vector2d* place(Index particle) const;

 private:
  struct Place {
    Index particle = kNone;
    Eigen::Vector2d at;
  };
  struct Border {
    Index edge = kNone;
    std::size_t beyond = 0;  ///< its side that is not laid out, 0 or 1
  };

  void add_triangle(Index triangle, const EdgeSides& from, std::size_t side);
  void cross(const Border& border);

  const FlatShapes& shapes_;
  const std::vector<EdgeSides>& edges_;
  const std::vector<std::array<Index, 3>>& of_;
  std::vector<Place> places_;
  std::vector<Index> triangles_;  // that are laid out
  std::vector<Border> borders_;   // in the order in which they were reached
  std::size_t crossed_ = 0;       // of these
};

}  // namespace weft
