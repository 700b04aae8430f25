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

/// The same in double.
template <class Real>
CornerUv corner_places(const ClothModel<Real>& model, Index triangle);

/// (u, v) of an edge's ends in one of its triangles, in the order of that triangle [m].
template <class Real>
std::array<std::array<Real, 2>, 2> stored_ends(const ClothModel<Real>& model,
                                               const TriangleSide& side);

/// Whether the only part of a model `rests_by_triangle`; false without a part.
template <class Real>
bool rests_by_triangle(const ClothModel<Real>& model);

/// Squared length of an edge at rest, of a model of one part [m^2]: by the mean of both lengths
/// where triangles rest on their own.
/// @param second  its other triangle; on the border the first again
template <class Real>
double rest_length2(const ClothModel<Real>& model, const TriangleSide& first,
                    const TriangleSide& second);

/// Corners of each hinge of a part that rests by triangle, with both triangles laid flat beside
/// each other [m], by the ends of its edge: first these ends, in the same order, then the third
/// corners. Both triangles keep their areas.
template <class Real>
std::map<Edge, std::array<Vec3d, 4>> unrolled_hinges(const ClothModel<Real>& model,
                                                     const ClothPart<Real>& part);

}  // namespace weft
