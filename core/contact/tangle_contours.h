#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/contact/contour_regions.h"
#include "core/types.h"

namespace weft {

/// An edge of a cloth that passes through a triangle of a cloth.
struct TangleCrossing {
  Index edge = kNone, triangle = kNone;
  double along = 0;                              ///< where on the edge, from its first end, 0 to 1
  std::array<double, 3> barycentric = {0, 0, 0};  ///< where in the triangle
  bool above = false;       ///< the edge's first end is on the side the triangle's normal points to
  Index contour = kNone;
  std::uint8_t side = 0;    ///< which of the contour's two sheets the edge belongs to
  std::array<Index, 2> link = {kNone, kNone};  ///< crossings before and behind it
};

/// A line along which two sheets pass through each other, or two parts of one: the crossings that
/// triangles have in common, one behind the other.
struct TangleContour {
  std::size_t begin = 0, end = 0;  ///< of its list of crossings
  /// The sheet that has to go back through the other one, and the side of that, by its triangles'
  /// normals, on which it must not be: 1 above, -1 below. 0 if no sheet is cut in two.
  std::uint8_t sheet = 0;
  int wrong = 0;
  /// Otherwise: the sheet that is to slide along the contour, from its first crossing to its last,
  /// out of the other one.
  std::uint8_t slides = 0;
};

/// Joins crossings to contours and decides for each which sheet goes which way.
///
/// Where a contour cuts a sheet in two, the smaller part is taken to be on the wrong side of the
/// other sheet (Baraff, Witkin, Kass 2003, who leave it at closed contours): what is pulled out
/// there makes it smaller still, so the choice lasts. A contour that cuts neither sheet in two
/// begins at the border of one and ends at the border of the other or where a fold closes, and
/// becomes shorter as these slide out of each other.
class TangleContours {
 public:
  TangleContours() = default;
  template <class Real>
  explicit TangleContours(const ClothModel<Real>& model);

  /// Joins what crosses now.
  /// @param crossings  gets its links, contours and sides
  /// @param is_held    of each particle 1 if it cannot be moved
  void join(std::vector<TangleCrossing>& crossings, const std::vector<char>& is_held);

  const std::vector<TangleContour>& list() const { return contours_; }
  /// Crossings contour by contour, each in its order.
  const std::vector<Index>& order() const { return order_; }
  /// The triangles at an edge; kNone for the second one of a border.
  const std::array<Index, 2>& triangles_of(Index edge) const {
    return triangles_of_[static_cast<std::size_t>(edge)];
  }
  /// The particle that the triangle of a crossing has in common with one at its edge, where a
  /// contour ends in a fold; kNone at a border.
  Index fold_at(const TangleCrossing& crossing) const;
  const ContourRegions& regions() const { return regions_; }

 private:
  void link(std::vector<TangleCrossing>& crossings);
  void follow(std::vector<TangleCrossing>& crossings, Index first);
  void decide(const std::vector<TangleCrossing>& crossings, const std::vector<char>& is_held,
              TangleContour& contour);

  std::vector<Triangle> triangles_;
  std::vector<std::array<Index, 2>> triangles_of_;  ///< of each edge
  std::vector<std::pair<std::uint64_t, Index>> keys_;  ///< pairs of triangles that meet
  std::vector<TangleContour> contours_;
  std::vector<Index> order_;
  std::vector<EdgeCut> cuts_;  ///< of one sheet by a contour
  ContourRegions regions_;
};

}  // namespace weft
