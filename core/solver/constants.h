#pragma once

#include <cstddef>

// The numbers that the solvers share; implicit/ has its own. Margins that follow from the widest
// vector stand with the kernels (grid_relaxation.h).

namespace weft {

// Blow-ups.

/// No scene extends farther from the origin [m]. Objects and cloths start within 100 m of it, and
/// beyond a kilometre single precision resolves less than the thickness of a fabric. Larger:
/// contact loses that precision. Smaller: cloth that falls or flies far is stopped as if it
/// diverged.
inline constexpr double kFarthestFromOrigin = 1000;

/// This speed is always allowed, however small the cloth [m/s]: twice the strongest wind. Above it,
/// no particle may move farther in a substep than its cloth's diagonal. Larger: a diverged small
/// cloth is noticed later. Smaller: cloth in a storm is stopped.
inline constexpr double kPlausibleSpeed = 200;

/// Particles of which one thread looks for blow-ups, or which it drifts, at least. Fewer: to deal
/// them out costs more than the work.
inline constexpr std::size_t kPassedAtLeast = 2048;

// Moving pins.

/// Turns in a substep in which rows between cloths push what pins lead, and the pins lead it on, at
/// most. More: slower steps while a pin moves in cloth that presses. Fewer: what such cloth hits is
/// off its place, and arrives late.
inline constexpr int kPinTurns = 20;

// Steps while contact cannot act.

/// Substeps after which positions are saved, to return to if a particle has left its path. Larger:
/// more steps are repeated then. Smaller: more time goes into saving.
inline constexpr int kCalmKeptSteps = 8;

/// Fraction of the allowed displacement from a path at which new paths are requested [1]: they cost
/// less than a return to saved positions. Larger: more returns. Smaller: more new paths.
inline constexpr double kCalmRenewal = 0.9;

/// Fraction of the distance to the nearest object that remains after rounding [1]. At 1 rounding
/// could let a particle come nearer than contact allows. Smaller: steps without contact end sooner.
inline constexpr double kCalmClearance = 0.999;

// Dashpots of bending.

/// Most that the fastest bending of a mesh may turn in its phase between two passes [rad]; at pi it
/// would not be damped. Larger: it nearly is not. Smaller: more passes.
inline constexpr double kMostBetweenPasses = 2.8;

/// Faster bending is not followed swing by swing [rad/s]: 200 Hz. Larger: more passes on fine
/// meshes at high tick rates. Smaller: waves of few centimetres may lose a quarter of their law.
inline constexpr double kFastestBending = 1257;

/// A group of three passes takes at most this long, rounding included [s]. Larger: in slow ticks
/// the dashpots see less of what swings. Smaller: more passes.
inline constexpr double kGroupSeconds = 1.001 / 60;

/// Most that the turning of the normal adds to the gradient of a curvature, over what bending gives
/// it [1]; where it is more, cloth is crumpled. Larger: more stages everywhere. Smaller: cloth that
/// is stretched unevenly is not damped.
inline constexpr double kMostTurning = 0.15;

/// Stages of a pass between ticks, at most; a fabric that needs more is refused [1]. Larger: ticks
/// of a fine mesh may take long. Smaller: less damping of fine meshes.
inline constexpr int kMostDashpotStages = 1000;

/// Least size of a band of particles, and bands of a cloth at most. On smaller and more bands,
/// threads that synchronise at every stage and the stencils of borders cost more than they save.
inline constexpr std::size_t kDashpotBandParticles = 2048, kMostDashpotBands = 8;

/// Time of a stage for each slot of a group, in that of an update of a particle by the springs of a
/// grid [1]: measured on one processor, for meshes; grids take less. Larger: more damped fabrics
/// are refused. Smaller: ticks may take longer than their cost said.
inline constexpr double kDashpotUpdates = 0.25;

/// Batches of stencils that all bands have together at most, over those of the cloth [1]: what is
/// on a border is evaluated several times. Larger: cloths whose particles are in no order are
/// divided too, at a cost that several threads do not make good.
inline constexpr double kMostTouched = 1.25;

// The moduli of XPBD.

/// Strain with which they are computed [1]. Larger: strains are no longer small. Smaller: what
/// keeps the squared length of springs positive counts.
inline constexpr double kProbedStrain = 1e-4;

/// Side of the square in the middle of a grid whose springs count [cells]. Larger: the border comes
/// nearer. Smaller: fewer springs to average over; it is even, as colours are.
inline constexpr int kProbedCells = 8;

/// Edges between the border of a mesh and the triangles that count, if it is wide enough [1].
/// Larger: fewer triangles. Smaller: the border counts.
inline constexpr int kMostRings = 8;

}  // namespace weft
