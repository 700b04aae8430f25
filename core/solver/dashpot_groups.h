#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/math/aligned_vector.h"

// The stencils of damped bending in groups, laid out for vector code.

namespace weft {

/// Groups of stencils that have particles and the cloth's normal in common: both lines through a
/// particle of a grid, the twist of a cell, all curvatures of a triangle. All groups of a family
/// have equally many, sixteen of them side by side make a batch, and batches are padded with groups
/// without viscosity.
///
/// Triangles read vectors as quads, anywhere in the model. Grids read them from planes: the x of
/// all particles of the part, then their y and their z, in the memory of the part's quads. Most
/// batches of a grid are of neighbours in a row, which follow each other there.
///
/// The normal is that of e x f. The line e runs from the particle in slot 0 to that in slot 1, and
/// f from slot 0 to 2 in a triangle, else from slot 2 to 3.
template <class Real>
struct DashpotFamily {
  static constexpr std::size_t kLanes = 16;
  static constexpr std::size_t kMostSlots = 64, kMostGridSlots = 5;

  std::size_t slots = 0;       ///< particles of a group; one may be in several slots
  std::size_t curvatures = 0;  ///< of a group, 1 to 3
  bool of_triangles = false;
  std::size_t groups = 0, batches = 0;  ///< without what pads the batches
  std::size_t first = 0, plane = 0;     ///< of a grid: its first particle, and how many it has
  /// By batch, slot and lane: four times the number of each particle in the model; of a grid its
  /// number in the part.
  std::vector<std::uint32_t> places;
  /// Of a grid, by batch: in all slots each lane has the particle after that of the lane before.
  std::vector<std::uint8_t> in_rows;
  /// Of triangles by batch, curvature, slot and lane; of a grid by curvature and slot, as all of
  /// its groups have the same.
  AlignedVector<Real> weights;
  AlignedVector<Real> viscosity;  ///< tau k, by batch, curvature and lane
  /// Found by `aim_dashpots`, by batch, number and lane: e, f and the normal, three numbers each;
  /// then by curvature how the normal's turning changes it, and its viscosity, 0 where cloth is
  /// crumpled.
  AlignedVector<Real> geometry;

  static constexpr std::size_t kOfNormal = 9, kOfCurvature = 4;
  /// Number in the model of the particle at a place.
  std::size_t particle(std::uint32_t place) const {
    return of_triangles ? place / 4 : first + place;
  }
  std::size_t geometry_numbers() const { return kOfNormal + kOfCurvature * curvatures; }
};

/// Lists the damped stencils of a part; empty if it has none.
template <class Real>
std::vector<DashpotFamily<Real>> dashpot_families(const ClothModel<Real>& model,
                                                  const ClothPart<Real>& part);

}  // namespace weft
