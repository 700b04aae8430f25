#pragma once

#include <cstddef>

// The numbers that the geometry assumes. Those that depend on the scalar type (thin triangles,
// parallel segments) and the sizes of search stacks stand in their algorithms.

namespace weft {

// Degenerate input.

/// Shortest vector that defines a direction, in its own units. Larger: directions given in small
/// units are refused. Smaller: the direction of a vector that was meant to be zero is rounding.
inline constexpr double kShortestDirection = 1e-9;

/// A triangle with at most this doubled area is degenerate [m^2]; with legs at right angles these
/// are 0.1 um long. `repair` removes it, `validate` refuses it. Larger: small triangles of fine
/// meshes go too. Smaller: triangles with less certain normals reach contact.
inline constexpr double kLeastDoubledArea = 1e-14;

/// Least volume inside a mesh that tells inside from outside, as a fraction of (surface area)^1.5.
/// A smaller one is rounding, such as that of a sheet with two coincident faces. Larger: thin
/// solids that face inwards are not turned. Smaller: rounding may turn a doubled sheet.
inline constexpr double kLeastEnclosedVolume = 1e-6;

// Polygons of mesh files.

/// Most corners of a polygon. More: cutting it, which takes the square of their number, takes
/// seconds. Fewer: round faces of fine models are refused.
inline constexpr std::size_t kMostPolygonCorners = 4096;

/// Angle [rad] below which a corner is flat, and a line passes through a corner. Larger: thin
/// polygons are cut as if their corners lay in a row. Smaller: corners in a slanting row, which the
/// file has rounded, give slivers.
inline constexpr double kFlatCorner = 1e-3;

/// Least doubled area of a polygon, as a fraction of the square of its circumference. Larger:
/// narrow faces have none. Smaller: the rounding of corners in a row is an area.
inline constexpr double kLeastPolygonArea = 1e-8;

// Repair of meshes.

/// Passes over the degenerate triangles of a mesh. Each pass may leave others with a shorter row of
/// collinear corners. More: longer rows are repaired, in more time. Fewer: what is left of a row is
/// removed, which opens a closed surface.
inline constexpr int kMostRepairPasses = 64;

// Limits of meshes.

/// Of a triangle mesh. Larger: longer loading, and more memory. Smaller: finer meshes are refused.
inline constexpr std::size_t kMostMeshVertices = 1'000'000;
inline constexpr std::size_t kMostMeshTriangles = 2'000'000;

/// Part of the mean edge of a border within which two of its vertices count as one [1]. Larger:
/// sheets that lie on each other become one cloth. Smaller: seams that were rounded stay open.
inline constexpr double kOpenSeam = 1e-5;

/// Farthest coordinate of a vertex in a file, before the mesh is scaled [units of the file].
/// Smaller: meshes in small units are refused, although scaled they would fit.
inline constexpr float kFarthestFileVertex = 1e6F;

// Searches.

/// Fraction by which a ray test widens boxes: above the rounding of double. Larger: more boxes are
/// entered. Smaller, down to the rounding: a ray may miss the box of a triangle that it hits.
inline constexpr double kRaySlack = 1e-12;

/// Beyond this number of primitives around one vertex, the seed's tree links each only to the next,
/// because all pairs of them would cost the square of their number. Larger: a hub costs more to
/// build. Smaller: fewer neighbours to group a primitive with, so looser boxes.
inline constexpr std::size_t kWidestFan = 16;

}  // namespace weft
