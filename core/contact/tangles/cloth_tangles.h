#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/feature_pair.h"
#include "core/contact/tangles/tangle_contours.h"
#include "core/math/quad.h"

// Undoes crossings that exist at the start.

namespace weft {

/// Finds where cloths pass through themselves or each other, and pulls them apart.
///
/// The guard prevents new crossings, so this only treats those present at the start. All edges that
/// pass through triangles are then searched for, exactly, and again many times a second until none
/// are left. They line up as contours, each of which determines which sheet moves in which
/// direction (TangleContours). Impulses act on the crossings themselves and give edge and triangle
/// a small speed past each other; the fabric carries its other particles along and keeps its folds.
/// Pairs of features near a contour, one of either sheet, are free: they have to pass each other
/// for the tangle to come undone, and pairs that are apart on the wrong side would hold it fast.
template <class Real>
class ClothTangles {
 public:
  ClothTangles() = default;
  explicit ClothTangles(const ClothModel<Real>& model);

  /// Clears everything.
  void reset();

  /// Begins a new search.
  void clear();

  /// Records a crossing if the edge passes through the triangle. They must share no particle.
  /// @param x  positions of all particles [m]
  void look_at(Index edge, Index triangle, const QuadArray<Real>& x);
  /// Removes crossings for which unwanted(crossing) is true.
  template <class Unwanted>
  void leave_out(Unwanted&& unwanted) {
    std::erase_if(crossings_, unwanted);
  }
  /// Records features that touch without a side; they are pulled apart too.
  /// @param particle  as in GuardedPair
  void note_touch(PairKind kind, const std::array<Index, 4>& particle, const QuadArray<Real>& x);
  /// Call after the search: determines the directions out of the tangle.
  /// @param inverse_mass  of each particle [1/kg]
  void decide(const QuadArray<Real>& x, const std::vector<Real>& inverse_mass);

  /// Whether the features of a pair may pass each other.
  bool frees(PairKind kind, const std::array<Index, 4>& particle) const;

  /// Pulls crossings apart by bounded impulses, after the kick of `dt` [s].
  void draw(ClothState<Real>& state, Real dt);

  std::size_t size() const { return crossings_.size(); }
  const std::vector<TangleCrossing>& crossings() const { return crossings_; }
  const TangleContours& contours() const { return contours_; }
  /// Work of `draw` since the start of the tick [J]; see begin_tick.
  double work() const { return work_; }
  void begin_tick() { work_ = 0; }

 private:
  // tangle_rows.cpp
  /// Two features, with the direction in which the first is pulled past the second.
  struct Row {
    std::array<Index, 5> particle = {0, 0, 0, 0, 0};
    std::array<Real, 5> weight = {0, 0, 0, 0, 0};
    Vec3<Real> direction = Vec3<Real>::Zero();
    Real inertia = 0;  ///< 1 / (sum of weight^2 / mass) [kg]
    Real pull = 0;     ///< impulse in this step [N s]
    Real wanted = 0;   ///< speed along the direction [m/s]
    Real speed = 0;    ///< along the direction before this step's kick, and now [m/s]
    Vec3<Real> apart;  ///< sum of weight x position at the previous step [m]
  };

  Vec3d at(Index particle, const QuadArray<Real>& x) const {
    return to_vector(x[static_cast<std::size_t>(particle)]).template cast<double>();
  }
  Vec3d normal_of(Index triangle, const QuadArray<Real>& x) const;
  Vec3d normal_at(Index edge, const QuadArray<Real>& x) const;
  Vec3d point_of(const TangleCrossing& crossing, const QuadArray<Real>& x) const;
  Vec3d direction_along(const TangleContour& contour, std::size_t place,
                        const QuadArray<Real>& x) const;
  void free_around(const TangleContour& contour);
  void place(Row& row, const QuadArray<Real>& x) const;
  Real speed_of(const Row& row, const ClothState<Real>& state) const;
  void begin_row(Row& row, const ClothState<Real>& state, Real dt) const;
  void add_rows(const TangleContour& contour, const QuadArray<Real>& x);

  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  std::vector<Index> triangle_at_;  ///< one triangle of each particle
  std::vector<TangleCrossing> crossings_;
  TangleContours contours_;
  std::vector<char> is_held_;
  /// Per particle a bit for each nearby contour, by the first and second sheet.
  std::array<std::vector<std::uint64_t>, 2> near_;
  std::vector<Row> rows_;
  double drawn_ = 0;  ///< duration of the pull [s]
  double work_ = 0;   ///< [J]
};

extern template class ClothTangles<float>;
extern template class ClothTangles<double>;

}  // namespace weft
