#pragma once

#include <array>
#include <map>

#include "core/cloth/cloth_model.h"
#include "core/geometry/triangle_sides.h"

// Where the corners of triangles lie in the fabric, also at its seams.

namespace weft {

/// (u, v) of a triangle's corners as the model stores them [m].
template <class Real>
std::array<std::array<Real, 2>, 3> stored_corners(const ClothModel<Real>& model, Index triangle);

/// The same, to calculate with.
template <class Real>
CornerUv corner_places(const ClothModel<Real>& model, Index triangle);

/// (u, v) of an edge's ends as one of its triangles has them, in the order of that [m].
template <class Real>
std::array<std::array<Real, 2>, 2> stored_ends(const ClothModel<Real>& model,
                                               const TriangleSide& side);

/// Whether the one part of a model rests so; false while it has none.
template <class Real>
bool rests_by_triangle(const ClothModel<Real>& model);

/// Squared length of an edge at rest, of a model of one part [m^2]. Triangles that rest on their
/// own are sewn there to their mean length.
/// @param second  its other triangle; on the border the first again
template <class Real>
double rest_length2(const ClothModel<Real>& model, const TriangleSide& first,
                    const TriangleSide& second);

/// Of a part that rests by triangle the corners of each hinge as both triangles lie flat beside
/// each other [m], those of the edge in the order of its ends, by which they are listed. Areas are
/// those of the triangles.
template <class Real>
std::map<Edge, std::array<Vec3d, 4>> unrolled_hinges(const ClothModel<Real>& model,
                                                     const ClothPart<Real>& part);

}  // namespace weft
