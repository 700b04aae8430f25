#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/contact/tangles/contour_regions.h"
#include "core/types.h"

// Contours: lines along which sheets pass through each other.

namespace weft {

/// An edge of a cloth that passes through a triangle of a cloth.
struct TangleCrossing {
  Index edge = kNone, triangle = kNone;
  double along = 0;  ///< position on the edge, from its first end, 0 to 1
  std::array<double, 3> barycentric = {0, 0, 0};  ///< position in the triangle
  bool above = false;  ///< the edge's first end is on the side of the triangle's normal
  Index contour = kNone;
  std::uint8_t side = 0;                       ///< the contour's sheet that the edge belongs to
  std::array<Index, 2> link = {kNone, kNone};  ///< previous and next crossing
};

/// Motion that undoes a tangle along a contour.
enum class TangleMotion : std::uint8_t {
  slide,   ///< a sheet slides along the contour, from its first crossing to its last
  back,    ///< a sheet moves back through the other one
  unfold,  ///< a pucker is pulled flat: both sheets move out of each other
};

/// A line along which two sheets, or two parts of one, pass through each other: crossings linked by
/// common triangles, in order.
struct TangleContour {
  std::size_t begin = 0, end = 0;            ///< of its list of crossings
  std::size_t free_begin = 0, free_end = 0;  ///< of its free particles
  TangleMotion motion = TangleMotion::slide;
  std::uint8_t sheet = 0;  ///< the one that moves back or slides
  /// Side of the other sheet, by its triangles' normals, from which this sheet moves back: 1 above,
  /// -1 below.
  int wrong = 0;
};

/// Links crossings into contours and decides for each which sheet moves in which direction.
///
/// If a contour cuts a sheet in two, the smaller part is assumed to be on the wrong side of the
/// other sheet (Baraff, Witkin, Kass 2003, who treat only closed contours): pulling it out makes it
/// smaller still, so the choice is stable. A contour that cuts neither sheet in two begins at the
/// border of one and ends at the border of the other or at a closing fold, and becomes shorter as
/// these slide out of each other.
class TangleContours {
 public:
  TangleContours() = default;
  template <class Real>
  explicit TangleContours(const ClothModel<Real>& model);

  /// Links the present crossings.
  /// @param crossings  receives links, contours and sides
  /// @param is_held    of each particle 1 if it cannot move
  void join(std::vector<TangleCrossing>& crossings, const std::vector<char>& is_held);

  const std::vector<TangleContour>& list() const { return contours_; }
  /// Crossings by contour, in order.
  const std::vector<Index>& order() const { return order_; }
  /// A particle whose features may pass those of the other sheet: otherwise a tangle could not come
  /// undone. In the moving sheet only particles on the wrong side are free.
  struct Free {
    std::uint8_t sheet;
    Index particle;
  };
  /// By contour, some of them twice.
  const std::vector<Free>& free() const { return free_; }
  /// The triangles at an edge; kNone for the second one at a border.
  const std::array<Index, 2>& triangles_of(Index edge) const {
    assert(static_cast<std::size_t>(edge) < triangles_of_.size());
    return triangles_of_[static_cast<std::size_t>(edge)];
  }
  /// The particle that a crossing's triangle shares with a triangle at its edge, where a contour
  /// ends in a fold; kNone at a border.
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
  std::vector<std::pair<std::uint64_t, Index>> keys_;  ///< pairs of intersecting triangles
  std::vector<TangleContour> contours_;
  std::vector<Index> order_;
  std::vector<Free> free_;
  std::vector<EdgeCut> cuts_;  ///< of one sheet by a contour
  ContourRegions regions_;
};

}  // namespace weft
