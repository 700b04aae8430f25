#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/contact/tangles/contour_regions.h"
#include "core/types.h"

namespace weft {

/// An edge of a cloth that passes through a triangle of a cloth.
struct TangleCrossing {
  Index edge = kNone, triangle = kNone;
  double along = 0;                               ///< where on the edge, from its first end, 0 to 1
  std::array<double, 3> barycentric = {0, 0, 0};  ///< where in the triangle
  bool above = false;  ///< the edge's first end is on the side the triangle's normal points to
  Index contour = kNone;
  std::uint8_t side = 0;  ///< which of the contour's two sheets the edge belongs to
  std::array<Index, 2> link = {kNone, kNone};  ///< crossings before and behind it
};

/// How a tangle comes undone along a contour.
enum class TangleWay : std::uint8_t {
  slide,   ///< a sheet slides along the contour, from its first crossing to its last
  back,    ///< a sheet goes back through the other one
  unfold,  ///< a pucker is pulled flat: both sheets go back out of each other
};

/// A line along which two sheets pass through each other, or two parts of one: the crossings that
/// triangles have in common, one behind the other.
struct TangleContour {
  std::size_t begin = 0, end = 0;            ///< of its list of crossings
  std::size_t free_begin = 0, free_end = 0;  ///< of its free particles
  TangleWay way = TangleWay::slide;
  std::uint8_t sheet = 0;  ///< that goes back or slides
  /// Side of the other sheet, by its triangles' normals, on which what has to go back is: 1 above,
  /// -1 below.
  int wrong = 0;
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
  /// A particle whose features may pass those of the other sheet: without this a tangle could not
  /// come undone. Of the sheet that goes those are free that are on the wrong side.
  struct Free {
    std::uint8_t sheet;
    Index particle;
  };
  /// Contour by contour, some of them twice.
  const std::vector<Free>& free() const { return free_; }
  /// The triangles at an edge; kNone for the second one of a border.
  const std::array<Index, 2>& triangles_of(Index edge) const {
    return triangles_of_[static_cast<std::size_t>(edge)];
  }
  /// The particle that the triangle of a crossing has in common with one at its edge, where a
  /// contour ends in a fold; kNone at a border.
  Index fold_at(const TangleCrossing& crossing) const;

 private:
  void link(std::vector<TangleCrossing>& crossings);
  void follow(std::vector<TangleCrossing>& crossings, Index first);
  void decide(const std::vector<TangleCrossing>& crossings, const std::vector<char>& is_held,
              TangleContour& contour);

  ContourRegions::Part cut(const std::vector<TangleCrossing>& crossings,
                           const std::vector<char>& is_held, const TangleContour& contour,
                           bool first, bool second);
  void set_free(const std::vector<TangleCrossing>& crossings, TangleContour& contour);

  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<Index, 2>> triangles_of_;     ///< of each edge
  std::vector<std::pair<std::uint64_t, Index>> keys_;  ///< pairs of triangles that meet
  std::vector<TangleContour> contours_;
  std::vector<Index> order_;
  std::vector<Free> free_;
  std::vector<EdgeCut> cuts_;  ///< of one sheet by a contour
  ContourRegions regions_;
};

}  // namespace weft
