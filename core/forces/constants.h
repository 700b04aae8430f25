#pragma once

#include <array>
#include <cstddef>

// The numbers that the forces assume, those of the air among them. Widths of vectors and the layout
// of lists stand with the kernels (grid_view.h, mesh_view.h).

namespace weft {

// Springs.

/// Added to a spring's squared length, so that divisions by it stay finite when both ends coincide
/// [m^2]. Larger: springs shorter than its root pull more weakly. Smaller: too small for float in
/// the dashpot, which divides by it; the elastic force divides by its root alone.
inline constexpr double kSmallestSquaredLength = 1e-14;

/// The same for a triangle's threads, whose length is 1 at rest [1]: added to its square. Larger: a
/// nearly collapsed triangle pulls more weakly. Smaller: too small for float beside the dashpot.
inline constexpr double kSmallestSquaredStretch = 1e-12;

/// Added to the determinant of a triangle's gradients, the inverse of twice its area, times the
/// lengths of its threads [1/m^2]: lanes without a triangle stay finite. Larger: triangles of many
/// square metres are softer. Smaller: infinite in float.
inline constexpr double kLeastDeterminant = 1e-25;

/// Forces on a grid see its places to the last bit where the steps of single precision would shake
/// them by more than this [m/s^2]. Larger: stiff cloth of small cells creeps where it sticks.
/// Smaller: cloth that does not bend so hard is slower.
inline constexpr double kMostShake = 0.1;

// Air.

/// Keeps the division by a normal's length finite for a triangle without area [m^4]. Larger: small
/// triangles feel less air. Smaller: it is zero in float below 1e-45.
inline constexpr double kSmallestSquaredNormal = 1e-30;

/// Bound of the length of SmoothNoise, whose components reach 1: more than the root of 3 [1].
/// Larger: more substeps in gusts, and air that counts as faster than it is. Smaller, below that
/// root: a gust may blow faster than the stability bound assumes.
inline constexpr double kLongestNoise = 2;

/// The eddies' own velocity, added to that of the mean wind [m/s]; ours. Larger: gusts in calm air
/// pass faster. Smaller: they stay longer; at zero they would stand still for ever.
inline constexpr std::array<double, 3> kDriftOfStillAir = {0.31, 0.17, 0.23};

/// Fraction of the jet's radius with the speed of the core; from there it fades to the edge [1].
/// Larger: a steeper edge, and more air. Smaller: a softer one.
inline constexpr double kFanCore = 0.7;

/// Distance from the disc over which the speed of a jet rises from 0, in radii of the disc [1].
/// Larger: cloth near the disc feels less wind. Smaller: a steeper rise at the disc.
inline constexpr double kFanStart = 0.25;

// Gathering passes over a mesh.

/// Springs, or pairs of triangles, at one particle; a mesh with more is stepped element by element.
/// Larger: the hub of a wheel leaves nearly all slots of its group unused. Smaller: fewer meshes
/// have the faster pass.
inline constexpr std::size_t kMostSpringsAtParticle = 64;

/// Relative difference up to which the springs of a mesh have one damping per stiffness [1].
/// Larger: dashpots that differ are replaced by a common one. Smaller: rounding in float sends the
/// mesh to the slower pass.
inline constexpr double kSameDamping = 1e-5;

// Passes over a grid on several threads.

/// Minimum size of a band of rows [particles, rows]: on smaller bands, threads that synchronise at
/// every substep and the two rows that a band recomputes cost more than they save. Larger: fewer
/// threads share a medium grid.
inline constexpr std::ptrdiff_t kBandParticles = 2048, kBandRows = 16;

/// Bands of a grid. Larger: more threads take part. Smaller: fewer rows are computed twice.
inline constexpr std::ptrdiff_t kMostBands = 4;

}  // namespace weft
