#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/feature_pair.h"
#include "core/contact/tangles/tangle_contours.h"
#include "core/math/quad.h"

namespace weft {

/// Where cloths pass through themselves or each other, and how they are drawn apart.
///
/// Nothing that the guard allows crosses, so this is only for what crosses when it begins. All
/// edges that pass through triangles are looked for then, exactly, and again many times a second
/// until there are none. They line up as contours, each of which says which sheet goes which way
/// (TangleContours). Drawn are the crossings themselves, by impulses that give edge and triangle a
/// small speed past each other; the fabric takes its other particles along and keeps its folds.
/// Pairs of features near a contour, one of either sheet, are free: they have to pass each other
/// for the tangle to come undone, and those that are apart on the wrong side would hold it fast.
template <class Real>
class ClothTangles {
 public:
  ClothTangles() = default;
  explicit ClothTangles(const ClothModel<Real>& model);

  /// Forgets everything.
  void reset();

  /// Begins to look again.
  void clear();

  /// Notes that an edge passes through a triangle, if it does. They have no particle in common.
  /// @param x  positions of all particles [m]
  void look_at(Index edge, Index triangle, const QuadArray<Real>& x);
  /// Forgets crossings again for which unwanted(crossing) is true.
  template <class Unwanted>
  void leave_out(Unwanted&& unwanted) {
    std::erase_if(crossings_, unwanted);
  }
  /// Notes features that touch without a side, which are drawn apart too.
  /// @param particle  as GuardedPair has them
  void note_touch(PairKind kind, const std::array<Index, 4>& particle, const QuadArray<Real>& x);
  /// After all have been looked at: finds the ways out.
  /// @param inverse_mass  of each particle [1/kg]
  void decide(const QuadArray<Real>& x, const std::vector<Real>& inverse_mass);

  /// Whether the features of a pair may pass each other.
  bool frees(PairKind kind, const std::array<Index, 4>& particle) const;

  /// Draws apart what crosses: bounded impulses, after the kick of `dt` [s].
  void draw(ClothState<Real>& state, Real dt);

  std::size_t size() const { return crossings_.size(); }
  const std::vector<TangleCrossing>& crossings() const { return crossings_; }
  const TangleContours& contours() const { return contours_; }
  /// Work that `draw` has done since the start of the tick [J]; see begin_tick.
  double work() const { return work_; }
  void begin_tick() { work_ = 0; }

 private:
  // tangle_rows.cpp
  /// Two features with the direction in which the first is drawn past the second.
  struct Row {
    std::array<Index, 5> particle = {0, 0, 0, 0, 0};
    std::array<Real, 5> weight = {0, 0, 0, 0, 0};
    Vec3<Real> direction = Vec3<Real>::Zero();
    Real inertia = 0;  ///< 1 / (sum of weight^2 / mass) [kg]
    Real pull = 0;     ///< impulse in this step [N s]
    Real wanted = 0;   ///< speed along the direction [m/s]
    Real speed = 0;    ///< along the direction before this step's kick, and now [m/s]
    Vec3<Real> apart;  ///< sum of weight x position a step ago [m]
  };

  Vec3d at(Index particle, const QuadArray<Real>& x) const {
    return to_vector(x[static_cast<std::size_t>(particle)]).template cast<double>();
  }
  Vec3d normal_of(Index triangle, const QuadArray<Real>& x) const;
  Vec3d normal_at(Index edge, const QuadArray<Real>& x) const;
  Vec3d point_of(const TangleCrossing& crossing, const QuadArray<Real>& x) const;
  Vec3d way_along(const TangleContour& contour, std::size_t place, const QuadArray<Real>& x) const;
  void free_around(const TangleContour& contour);
  void place(Row& row, const QuadArray<Real>& x) const;
  Real speed_of(const Row& row, const ClothState<Real>& state) const;
  void begin_row(Row& row, const ClothState<Real>& state, Real dt) const;
  void add_rows(const TangleContour& contour, const QuadArray<Real>& x);

  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  std::vector<Index> triangle_at_;  ///< one of each particle's
  std::vector<TangleCrossing> crossings_;
  TangleContours contours_;
  std::vector<char> is_held_;
  /// Of each particle a bit for each contour near by whose first or second sheet it belongs to.
  std::array<std::vector<std::uint64_t>, 2> near_;
  std::vector<Row> rows_;
  double drawn_ = 0;  ///< for how long [s]
  double work_ = 0;   ///< [J]
};

extern template class ClothTangles<float>;
extern template class ClothTangles<double>;

}  // namespace weft
