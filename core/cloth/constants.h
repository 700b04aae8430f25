#pragma once

#include "core/ranges.h"

// The numbers that the cloth model assumes. Fabrics have theirs in fabric_presets.cpp, with the
// unit of its sources.

namespace weft {

// Places on the fabric.

/// Rounding of a place about a circle, as fractions of the circle's radius and of the distance of
/// its middle from the origin of the fabric [1]; the latter are a few roundings of a float. Larger:
/// discs hold particles beyond them. Smaller: rounding decides about those on their circles.
inline constexpr double kDiscSlack = 1e-5, kPlaceSlack = 5e-7;

// Stability of the explicit solver.

/// Margin of the springs' squared frequency over its row sums [1]. Linear theory requires less: the
/// highest frequency of a net is up to a third below them. Larger: more substeps, as its root.
/// Smaller: a crushed cloth may stay stretched to eight times its size forever, with finite numbers
/// throughout (tests/laws/shaking_test.cpp); at the highest frequency itself it always does.
inline constexpr double kShakenMargin = 1.15;

/// Rounds in which the bound of the area that the air damps is lowered. More: a longer build.
/// Fewer: a higher bound, of one round by a fifth on grids.
inline constexpr int kDampedAreaRounds = 4;

/// Rounds in which triangles of a mesh find the shares of their corners' masses that make the bound
/// of their frequency low [1]. Larger: loading takes longer, for a bound that is hardly lower.
/// Smaller: more substeps on meshes with some bad triangles.
inline constexpr int kMassSharingRounds = 24;

/// Least weight of a corner in them, where the fabric resists in one direction only [1]. Larger: a
/// worse start. Smaller: shares that are rounding.
inline constexpr double kLeastCornerWeight = 1e-3;

/// Length of a thread, 1 at rest, below which stretching does not raise the bound of a mesh's
/// frequency: kShakenMargin has room for it [1]. Larger: a strongly stretched cloth may become
/// unstable. Smaller: more substeps while cloth hangs.
inline constexpr double kFreeStretch = 1.05;

/// Most substeps of a tick; what needs more is too stiff for the explicit solver. Also the largest
/// number in a definition. Larger: stiffer and finer cloth, and ticks that take as much longer.
/// Smaller: a diverged tick is repeated with twice its substeps in fewer cases.
inline constexpr int kMostSubsteps = 20000;

/// Least fraction of its stiffness that a softened cloth keeps [1]; below it fabric is a rubber
/// band. Larger: a world that is too slow saves fewer substeps, as the root. Smaller: softer cloth.
inline constexpr double kLeastSoftness = kSoftnessRange.minimum;

// Bending.

/// Below this fraction of its rest area, a crumpled triangle acts on its hinges with less leverage
/// [1]. Larger: cloth that is merely compressed resists bending less. Smaller: a nearly flattened
/// triangle, whose lever is 1 / height, gives larger forces.
inline constexpr double kCrumpledArea = 0.05;

/// Smaller rest angles of a mesh are rounding [rad]: it counts as flat. Larger: slight folds at
/// rest are lost where `automatic` takes the quadratic form.
inline constexpr double kFlatRestAngle = 1e-5;

/// So does a piece of a mesh whose vertices lie this near to a plane, as a fraction of its mean
/// edge [1], plus this many roundings of its coordinates. Larger: slight curves at rest are lost.
/// Smaller: rounding of a file's vertices makes a flat mesh a curved one, which takes longer.
inline constexpr double kFlatRest = 1e-3, kRoundingsOfFlat = 4;

/// Height of the lower of two triangles that lie on each other at an edge, over that of the higher
/// one, from which on they are a fold [1]. Larger: folded meshes are taken for flat ones. Smaller:
/// needles that rounding has turned over make a flat mesh a curved one.
inline constexpr double kLeastFold = 0.01;

/// Error of a slope across an edge up to which it is not corrected, relative to the rise of a
/// quadratic field to the next particle [1]. Larger: meshes bend too stiffly by up to this.
/// Smaller: rounding of a regular mesh's vertices couples each particle to half as many more.
inline constexpr double kRightSlope = 3e-4;

/// Least eigenvalue at which the particles around an edge distinguish quadratic fields; a wide
/// patch of them has about 0.1 [1]. Larger: slopes use more particles, and bending takes longer.
/// Smaller: large weights, and more substeps.
inline constexpr double kTellsApart = 5e-4;

/// Times that neighbours are added to the particles around an edge to distinguish fields [1].
/// Larger: no difference on wide meshes. Smaller: slopes at corners are not exact.
inline constexpr int kSlopeRounds = 2;

/// Slopes beside a particle with more neighbours than this do not use them [1]. Larger: fans take
/// long to build. Smaller: slopes at dense vertices are not exact.
inline constexpr std::size_t kMostSpokes = 32;

/// A link of bending is left out below this weight, relative to the smaller diagonal entry of its
/// two particles [1]. Larger: flat cloth has forces. Smaller: rounding of a regular mesh's vertices
/// couples each particle to half as many more.
inline constexpr double kLeastLink = 1e-8;

/// Height of a triangle over an edge, relative to how far its surroundings reach from the edge's
/// line, below which it is a needle [1]. Larger: triangles of graded meshes are fitted to their
/// surroundings. Smaller: needles bend stiffly, and take more substeps.
inline constexpr double kNeedle = 0.15;

/// Largest weight of a slope, times the distance of the particles that it uses, beyond which it is
/// that of a least-squares fit; 1 to 3 on regular meshes [1]. Larger: edges between oblique
/// triangles take more substeps. Smaller: slopes use particles farther away.
inline constexpr double kMostSlopeWeight = 5;

/// Triangles around an edge that are unfolded at most [1]. Larger: more time where only a vertex
/// connects two parts. Smaller: particles that slopes need are left out.
inline constexpr std::size_t kMostUnfolded = 512;

/// Largest factor of the bending of a mesh's triangle that a strip holds in part [1]. Larger: a
/// stiff triangle takes more substeps. Smaller: where it is held nearly whole the cloth bends from
/// behind the strip's border.
inline constexpr double kMostMeshStiffening = 32;

/// An edge that extends by less than this along a thread direction has the other direction [m].
/// Larger: the diagonals of very small cells count as threads. Smaller: rounding may make a thread
/// a diagonal, which has next to no rigidity in that direction.
inline constexpr double kAlongThread = 1e-9;

// Definitions.

/// Largest cosine between the directions of a cloth's sides [1]: rounding of a file. Larger: a
/// cloth may start sheared. Smaller: directions in a file need more digits.
inline constexpr double kMostAxisCosine = 1e-6;

/// Least doubled area of a triangle in a mesh's texture coordinates, as a fraction of the mean
/// area, below which it is a hole in them [1]. Larger: unevenly stretched coordinates are ignored
/// too. Smaller: threads of a triangle may have directions that are rounding.
inline constexpr double kLeastUvArea = 1e-9;

/// Least part of a mesh's area that has texture coordinates, so that holes are filled [1]. Larger:
/// more meshes are projected along an axis instead. Smaller: most threads are a guess.
inline constexpr double kLeastUvPart = 0.5;

}  // namespace weft
