#pragma once

#include <cassert>
#include <limits>

#include "core/contact/objects/mesh_shape.h"
#include "core/types.h"

// What the corners of edges and triangles of a cloth say of all their points.

namespace weft {

/// No point of an edge or a triangle is farther from its nearest corner than this part of its
/// longest side, which is 1/sqrt(3) for the centre of an equilateral triangle; by the square of it
/// the distance of a point from anything may fall short of that of the corners.
inline constexpr double kEdgeSpan = 0.5, kTriangleSpan = 0.578;

/// What the corners of an edge or a triangle keep to while rows hold.
template <class Real>
struct Corners {
  Real span = 0;   ///< no point is farther from the nearest of them [m]
  Real reach = 0;  ///< that none goes beyond [m]
  Real gap = std::numeric_limits<Real>::infinity();  ///< from all meshes, at least [m]
  Real unseen = 0;                                   ///< that may be missing in a distance [m]

  /// Whether corners alone keep off a round object, as they are so far from its core: of points at
  /// x_i with weights w_i the middle is off any point q by less than the corners are, in squares,
  /// by sum w_i w_j |x_i - x_j|^2 over pairs.
  /// @param least  that they are from it while the rows hold [m]
  bool clear(Real least, Real radius) const {
    assert(radius >= 0 && unseen >= 0);
    const Real most = radius + unseen;
    return least > 0 && least * least - span * span > most * most;
  }
  /// Whether corners alone keep off a ridge or corner of a mesh, if it goes on as it is there: an
  /// estimate, and nothing to rely on.
  bool clear(const Rise<Real>& rise) const { return gap > rise.over(span) + unseen; }

  /// The same if the last step within their reach pushes them out besides.
  /// @param part  kEdgeSpan or kTriangleSpan
  /// @param way   of the push, at most [m]
  Corners pushed(double part, Real way) const {
    Corners corners = *this;
    corners.span += 2 * way * static_cast<Real>(part);
    return corners;
  }

  /// What keeps them off where they lie, while what they may come to is only certified: at rest
  /// particles alone carry the cloth on a smooth object.
  /// @param part  kEdgeSpan or kTriangleSpan
  /// @param off   gap that they lie off by [m]
  Corners as_lying(double part, Real off) const {
    Corners corners = *this;
    corners.span -= 2 * corners.reach * static_cast<Real>(part);
    corners.gap = off;
    return corners;
  }
};

}  // namespace weft
