#pragma once

#include <cstddef>

// The numbers that a world and its ticks assume. The greatest numbers of things in a scene stand
// beside their structs, in world_def.h and script.h.

namespace weft {

// Cost of a scene. The limits are sizes that one machine serves.

/// Particles of all cloths together. This admits a cloth of 512 x 512, with frames of 3 MB. Larger:
/// longer ticks and larger frames. Smaller: fine cloths are refused.
inline constexpr std::size_t kMostWorldParticles = 300'000;

/// Triangles of all cloths, and of all objects. A mesh message has 12 bytes per triangle. Larger:
/// larger messages. Smaller: fine meshes are refused.
inline constexpr std::size_t kMostWorldTriangles = 1'000'000;

/// Updates of particles by the solver's springs in one tick. An update takes 3 to 5 ns for the
/// springs of a grid and 10 ns for those of a mesh, so that a tick stays below two seconds of CPU.
/// Larger: longer ticks. Smaller: stiff or fine cloths are refused.
inline constexpr double kMostTickUpdates = 1.5e8;

/// The same per simulated second [1/s]: about a minute of CPU.
inline constexpr double kMostUpdatesPerSecond = 1e10;

/// Cost of a Newton step with its linear systems in sweeps: 5 to 10 iterations of conjugate
/// gradients, each with a cycle over all levels of the grid. Larger: implicit scenes are refused
/// that could be served. Smaller: some are accepted that cannot.
inline constexpr double kSweepsOfNewton = 60;

/// Speed that cloth would have if all energy that a change of its fabric puts into its shape moved
/// it [m/s]; as fast as a hand. Larger: changes of crumpled cloth to fabrics a million times as
/// stiff end in ticks of seconds. Smaller: changes that only make it jump are refused.
inline constexpr double kFastestRelease = 30;

// Substeps.

/// Most substeps that a hand alone may ask for, as a multiple of those for the cloth [1] or as a
/// number per tick, whichever is more. Larger: cloth that a hand presses against something loses
/// less of its motion, in longer ticks. Smaller: it loses more.
inline constexpr long kHandSubstepFactor = 2, kEnoughHandSubsteps = 40;

/// How many more times the substeps are taken by verlet without damping, of a fabric that locks or
/// is stretched so far that its bound grows [1]. Larger: longer ticks. Smaller: it gains energy;
/// with 0 it tears itself apart in seconds, with 3 a mesh let go at twice its length gains 15 %.
inline constexpr double kUndampedMargin = 5;

/// Damping ratio of the highest mode from which on none more are taken [1]. Larger: longer ticks.
/// Smaller: gains of energy that the damping does not outweigh.
inline constexpr double kDampsEnough = 0.01;

/// Least substeps of implicit in a tick in which a pin moves and which verlet cannot step [1].
/// Larger: longer ticks. Smaller: the pin jumps farther between two of them, and the cloth is
/// stopped.
inline constexpr int kFewestDriven = 32;

/// Most times the usual substeps that a run may be repeated with [1]. Larger: rounding in float
/// exceeds what a finer step gains. Smaller: errors have no reference to be checked against.
inline constexpr int kMostRefinement = 16;

// Repetitions that measure a run's error.

/// Noise in the starting positions of one repetition [m rms]. Larger: smooth runs appear chaotic.
/// Smaller: rounding in float hides it at a metre from the origin.
inline constexpr double kStartNoise = 1e-6;

// Recovery.

/// Retries of a diverged tick, each with twice the substeps of the one before. More: fewer cloths
/// are stopped, and a tick that cannot be saved takes longer, twice as long with each.
inline constexpr int kMostTickRetries = 2;

/// Factor by which the energy of a tick may exceed what has a source [1]: twice the variation of
/// the highest modes. Larger: a runaway is noticed later. Smaller: normal operation near the
/// stability limit counts as one.
inline constexpr double kRunawayFactor = 20;

/// Time in which unexplained credit decays, as by a first-order lag [s]; a sixtieth of a second
/// keeps 0.95 of it. Larger: energy that was lost long ago excuses a runaway. Smaller: energy that
/// is only hidden by the instant of a sum is forgotten.
inline constexpr double kCreditSeconds = 19.0 / 60;

/// Energy at this speed is never suspicious [m/s]. Larger: slow runaways are missed. Smaller: a
/// resting cloth that begins to move may count as one.
inline constexpr double kUnsuspiciousSpeed = 1;

// Sleep.

/// Ticks for which boxes are extrapolated, so that a cloth wakes before it is touched. Larger:
/// cloth wakes for what only passes by. Smaller: it may be touched while it sleeps.
inline constexpr int kSleepTicksAhead = 2;

// Warnings and verdicts.

/// Strain of hanging above which springs count as not held [1]; strain_of_hanging is measured up to
/// it. Larger: scenes that sag out pass without a warning. Smaller: warnings for what holds.
inline constexpr double kMostHangingStrain = 0.15;

/// Share of a modulus below which XPBD counts as softer than asked for [1]. Larger: warnings for
/// invisible differences. Smaller: cloth is a tenth too soft without a warning.
inline constexpr double kLeastModulusShare = 0.95;

/// Side of the grid on which its moduli are computed [cells]. Larger: it takes longer. Smaller: the
/// border counts.
inline constexpr int kModulusCells = 32;

/// Strain of a mesh's triangles in its uv up to which these count as where it lies flat [1].
/// Larger: distorted uv pass, and the moduli are off by as much. Smaller: those of rounded files
/// are unknown.
inline constexpr double kUvStrain = 0.01;

/// Springs that may be relaxed to compute the moduli of a cloth once, some hundredths of a second,
/// and what a triangle counts for [1]. Larger: scenes are built more slowly, as they are computed
/// up to a dozen times. Smaller: those of large meshes, or of many sweeps, are not known.
inline constexpr double kMostProbedSprings = 4e6;
inline constexpr double kSpringsOfTriangle = 8;

/// Energy without a source that a hard case may gain, as a fraction of the energy in play [1].
/// Larger: a solver that heats cloth passes. Smaller: rounding fails a case.
inline constexpr double kMostEnergyExcess = 0.01;

/// Distance from its rest shape of a cloth that must have returned, as a fraction of its extent
/// [1]. Larger: cloth that stays tangled passes. Smaller: cloth that still swings fails.
inline constexpr double kMostRestError = 0.01;

/// Depth inside a round object that counts as a crossing, as a fraction of its radius [1]; contact
/// in float keeps no finer distance. Larger: shallow crossings are not counted. Smaller: rounding
/// is.
inline constexpr double kInRoundFraction = 1e-5;

// Picking.

/// Shortest direction of a ray [1]; it comes from a viewer's pixels and may be of any scale.
/// Larger: rays in small units are refused. Smaller: their direction is rounding.
inline constexpr double kShortestRay = 1e-12;

}  // namespace weft
