#pragma once

namespace weft {

/// No point of an edge or a triangle is farther from its nearest corner than this part of its
/// longest side, which is 1/sqrt(3) for the centre of an equilateral triangle; by the square of it
/// the distance of a point from anything may fall short of that of the corners.
inline constexpr double kEdgeSpan = 0.5, kTriangleSpan = 0.578;

}  // namespace weft
