#pragma once

#include <array>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/neighbours.h"
#include "core/contact/feature_pair.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/math/quad.h"
#include "core/types.h"

// What the guard knows of the cloths of a world: their features, thickness and friction.

namespace weft {

/// Cloths as the guard sees them. Nothing of it changes while the world runs.
template <class Real>
struct GuardedCloths {
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  /// Of each triangle, the particle across the edge opposite each corner; kNone on a rim.
  std::vector<std::array<Index, 3>> across;
  Neighbours neighbours;
  QuadArray<Real> rest_positions;
  std::vector<IndexRange> particles_of;         ///< of each cloth
  std::vector<Real> thickness, friction, cell;  ///< of each cloth; cell: length of its edges [m]
  std::vector<Real> inverse_area;  ///< of the fabric that belongs to each particle [1/m^2]
  Real thickest = 0;               ///< largest thickness [m]
  Real finest = 0;                 ///< smallest cell [m]
  Real reach = 0;                  ///< radius of the balls around predicted paths [m]
  /// The balls of pairs that are far apart in the fabric count as wider by this, so that thick
  /// cloth has their rows before it is pressed [m].
  Real margin = 0;
};

template <class Real>
GuardedCloths<Real> guarded_cloths(const ClothModel<Real>& model);

/// The cloth that a particle belongs to.
template <class Real>
Index cloth_of(const GuardedCloths<Real>& cloths, Index particle);

/// Distance up to which a pair is found even if its balls do not meet [m]; 0 if its features are so
/// near in the fabric that the fabric itself holds them apart.
template <class Real>
Real seen_from(const GuardedCloths<Real>& cloths, const std::array<Index, 4>& particles);

/// Distance that the features of a pair keep [m]: the mean of their thicknesses, but no more than
/// the fabric leaves to neighbours.
/// @param p, q  cloths of its sides
template <class Real>
Real kept_distance(const GuardedCloths<Real>& cloths, const GuardedPair<Real>& pair, Index p,
                   Index q);

/// Whether the nearest points of a particle and a triangle are the nearest of the surfaces around
/// them. Where a neighbour of either comes nearer, that one has to respond: a plane between
/// features that only pass each other is aslant, and would brake what slides and lift it.
/// @param x          positions [m]
/// @param particles  the one that is near, and the triangle's corners
/// @param pushes     the two push each other already
template <class Real>
bool own_nearest(const GuardedCloths<Real>& cloths, const QuadArray<Real>& x, Index triangle,
                 const std::array<Index, 4>& particles, const PairSeparation<Real>& s, bool pushes);

}  // namespace weft
