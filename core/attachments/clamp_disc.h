#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/cloth/cloth_model.h"

// Where the circle of a pinned disc clamps a grid.

namespace weft {

/// A pinned disc of a grid, which is flat and level up to its circle.
///
/// Along each row and column that the circle crosses, it clamps as the border of a strip does
/// (clamp_line.h): with e cells from the last held particle to the circle, the bending along that
/// line about that particle gets the factor 1 / (1/2 - e). A particle is held if it lies within the
/// circle, or beyond it by less than 5/8 of a cell along its row or its column, so that e <= 3/8
/// everywhere. Without the factors the cloth would bend about the staircase of the particles
/// within, and drape by the cell. Lines that only touch the circle, to within rounding, miss it.
struct ClampDisc {
  std::size_t part = 0;                 ///< of the model
  std::array<double, 2> middle = {};    ///< (u, v) [m]
  double radius = 0;                    ///< [m]
  std::array<double, 2> cell = {1, 1};  ///< distance of the lines along u and v [m]

  /// How far a place lies beyond the circle along u (0) or v (1), in cells of that direction;
  /// negative within, infinite where the line along that axis misses the circle.
  double beyond(const std::array<double, 2>& place, std::size_t axis) const;

  bool holds(const std::array<double, 2>& place) const;

  /// How far rounding may move a place over the circle [m].
  double slack() const { return disc_slack(middle, radius); }
};

/// The clamp of a disc around a particle: of a grid that bends by the quadratic form, if its radius
/// is kLeastClampedDisc cells or more. A smaller one holds only the particles within it.
template <class Real>
std::optional<ClampDisc> clamp_of_disc(const ClothModel<Real>& model, Index centre, double radius);

/// The particles that a disc holds, ascending.
template <class Real>
std::vector<Index> particles_of_disc(const ClampDisc& disc, const ClothModel<Real>& model);

/// Sets the factors of a disc, 0 to kMostStiffening, at the sites of its part's grid.
/// @param held     the particles that it holds
/// @param sites    of the part's particles
/// @param factors  one for each site
template <class Real>
void put_disc(const ClampDisc& disc, std::span<const Index> held, const ClothModel<Real>& model,
              const std::vector<Index>& sites, std::vector<std::array<double, 2>>& factors);

}  // namespace weft
