#pragma once

#include <cstddef>

// The numbers that the implicit solver assumes.

namespace weft {

// When verlet steps a tick instead.

/// Least number of substeps per tick if there is anything to meet [1]: contact acts between
/// substeps, and its constraints are not part of their equations. Larger: longer ticks. Smaller:
/// what touches sinks in and slides.
inline constexpr int kFewestInContact = 4;

/// Fraction of kinetic and elastic energy lost in a violent substep [1]. Larger: shaken cloth keeps
/// less of its waves. Smaller: verlet steps more ticks.
inline constexpr double kViolentLoss = 0.1;

/// A violently shaken cloth has at least the energy of all its particles at this speed [m/s].
/// Larger: the waves of slow cloth are damped away. Smaller: cloth near rest counts as violent.
inline constexpr double kViolentSpeed = 1;

/// And one of its springs or triangles has this strain [1]. Waves in a stiff cloth that snaps taut
/// may have as much energy, and may be damped. Larger: less cloth counts as violent. Smaller: stiff
/// cloth does.
inline constexpr double kViolentStrain = 0.1;

/// Largest displacement of a particle in a substep, relative to its neighbours, that the guard can
/// handle, in mean edge lengths [1]. Larger: what passes by within a substep is seen late. Smaller:
/// verlet steps more ticks.
inline constexpr double kFarDisplacement = 1;

// Energy.

/// Unexplained energy that counts as rounding, as a fraction of kinetic and elastic energy [1].
/// Larger: a gain is seen late. Smaller: float's rounding is taken for one.
inline constexpr double kRoundingEnergy = 1e-4;

/// Time in which the lost energy that may return decays, as by a first-order lag [s]; a sixtieth of
/// a second keeps 0.9 of it. The scheme loses for a moment the energy that a wave returns later.
/// Larger: an old loss excuses a new gain. Smaller: waves that return are damped.
inline constexpr double kKeptCreditSeconds = 9.0 / 60;

/// Largest number of pieces of a divided substep [1]. Larger: longer ticks where energy appears.
/// Smaller: more of it stays.
inline constexpr int kMostPieces = 64;

// Linear systems.

/// Iterations of conjugate gradients after which a system counts as not solved [1]. Larger: longer
/// ticks where it does not converge. Smaller: hard systems that converge slowly are given up.
inline constexpr int kMostLinearIterations = 200;

/// The same where only the diagonal blocks precondition, whose iterations cost little [1]. A sheet
/// of 51 x 51 of stiff fabric takes 300.
inline constexpr int kMostDiagonalIterations = 1000;

/// Fraction of the tolerance that such systems have [1]: their residual, measured by the diagonal
/// blocks, is small long before the slow bends are found. Larger: meshes lose motion. Smaller:
/// iterations for digits that the steps do not have.
inline constexpr double kDiagonalTolerance = 0.1;

/// Later linear systems of a substep need not be solved better than this fraction of the first
/// one's tolerance [1]. Larger: less exact Newton iterations. Smaller: more iterations for digits
/// that the first system does not have.
inline constexpr double kEnoughOfTolerance = 0.1;

// Factors.

/// A matrix is factored if that takes no longer than this many iterations without the factors [1].
/// Larger: longer ticks of large meshes. Smaller: longer ones of small and stiff meshes.
inline constexpr std::size_t kIterationsOfFactor = 150;

/// Groups of this many particles are not halved any more [1]. Larger: more blocks fill. Smaller:
/// the border of a half is most of it.
inline constexpr std::size_t kUndividedParticles = 8;

// Multigrid.

/// Levels with at most this many lines in one direction are not coarsened [1]. Larger: more sweeps
/// on a larger coarsest level. Smaller: levels on which a bend has no room.
inline constexpr int kCoarsestLines = 5;

/// Sweeps on the coarsest level [1]. Larger: more work there. Smaller: slower convergence.
inline constexpr int kCoarsestSweeps = 30;

/// Damping of the block Jacobi sweeps [1]: 1 / (0.583 lambda) with the bound lambda = 2. Larger:
/// high modes are not smoothed. Smaller: all are, slowly.
inline constexpr double kJacobiDamping = 0.857;

/// Factor by which pinned particles are heavier on the coarse levels [1]. Larger: float loses the
/// entries of free particles beside it. Smaller: coarse levels move pinned particles.
inline constexpr double kPinnedWeight = 1e5;

/// Sine of the angle between the threads of a triangle below which it has no normal [1]: it then
/// gets no stiffness from its tension. Larger: more of a crushed cloth is solved in more steps.
/// Smaller: a normal that is rounding.
inline constexpr double kLeastThreadSine = 1e-3;

/// Bending with a matrix smaller than this fraction of the inertia is left to the finest level [1].
/// Larger: cloth that hardly bends converges slowly. Smaller: coarse levels do work in vain.
inline constexpr double kSmallBending = 0.1;

}  // namespace weft
