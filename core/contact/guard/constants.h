#pragma once

#include <cstddef>

// The numbers that contact of cloths with each other assumes. Those of the vector code for rows
// stand in row_blocks.h, those of patches with their tree.

namespace weft {

// Predicted paths.

/// Length of a mesh's edges that counts, as a fraction of their mean [1]: they vary. Larger: more
/// neighbours become pairs where the mesh is fine.
inline constexpr double kMeshCell = 0.8;

/// Radius of the balls around predicted paths, as a fraction of the thickness, and its upper and
/// lower bounds as fractions of the edge length [1]. Larger: paths last longer, and more features
/// become pairs; beyond the upper bound all neighbours do. Smaller: paths are renewed more often.
inline constexpr double kReachPart = 0.65, kMostReach = 0.28, kLeastReach = 0.1;

/// What is far apart in the fabric is found at twice this fraction of the thickness, even if that
/// is farther than the balls meet [1]: what is first found when it is pressed already is pushed
/// out, lost from sight, and never rests. Larger: more pairs of thick cloth that keep off anyway.
/// Smaller: cloth thicker than half an edge is found late.
inline constexpr double kSightPart = 0.55;

/// Features that are near in the fabric keep no more than this many radii of the balls [1], which
/// are found at twice the radius. Larger: see above. Smaller: tight folds of thick cloth close.
inline constexpr double kSeenPart = 1.65;

/// Paths hold while the mean particle moves by the first fraction of an edge or the second of the
/// balls' radius [1], but neither longer than these seconds nor shorter than these substeps.
/// Larger: fewer collections, of more pairs.
inline constexpr double kHorizonPart = 0.14, kHorizonReach = 0.86, kLongestHorizon = 0.25,
                        kFewestSubsteps = 4;

/// While something crosses it is examined again after this time [s]. Larger: what comes apart is
/// pulled for longer. Smaller: more collections while a tangle lasts.
inline constexpr double kLookAgain = 1.0 / 120;

/// Fraction of the reach beyond which a particle is given a new path together with those that have
/// left theirs [1]. Larger: more renewals. Smaller: more particles in each.
inline constexpr double kSoon = 0.6;

/// All pairs are collected anew if more than 1 / this of all particles have left their paths [1].
/// Larger: more collections. Smaller: renewals that cost more than a collection.
inline constexpr std::size_t kManyStrays = 24;

// Parts of work: so small that they occupy the threads, and large enough to pay for waking them.

/// Parts of a pass over all pairs that keeps a number for each particle, at most, and pairs of one
/// at least. More parts: more numbers to merge. Smaller parts: threads cost more than they save.
inline constexpr std::size_t kMostPairParts = 4, kListedAtLeast = 4096;

/// Patches tested and fitted, particles anchored, pairs examined, particles copied by one part at
/// least. Larger: fewer threads have work. Smaller: threads cost more than they save.
inline constexpr std::size_t kPatchesAtLeast = 128, kFitsAtLeast = 128, kAnchoredAtLeast = 8,
                             kPairsAtLeast = 512, kCopiesAtLeast = 2048;

/// Pairs that are tested together. Larger: columns leave the nearest cache. Smaller: more columns
/// that are not full.
inline constexpr std::size_t kPairsAtOnce = 1024;

// Regions.

/// The bound of a gap is measured anew unless it leaves a particle room for this many of its steps
/// [1]. Larger: more measuring. Smaller: particles are anchored again sooner.
inline constexpr double kStepsOfRoom = 3;

/// Waves of anchoring after which all pairs are measured anew; more than ever seen. Smaller: a
/// chain of particles that wait for each other costs a whole measurement.
inline constexpr int kMostWaves = 48;

/// Speed added to both sides of a pair when they share its gap, so that the slower side gets a
/// share too, as a fraction of the faster one's speed [1]. Larger: gaps are shared more equally,
/// and the faster side is anchored more often. Smaller: the slower side has no room when it begins
/// to move.
inline constexpr double kLeastShare = 0.08;

/// Every side gets at least this fraction of a gap, rounding included [1].
inline constexpr double kLeastOfGap = kLeastShare / (1 + 2 * kLeastShare) * 0.999;

// Critical steps.

/// Rounds of looking for an axis for each pair before all that are left stop at planes. More: less
/// motion is lost, in more time.
inline constexpr int kRounds = 12;

/// Renewals in one step for particles that were stopped off their paths, before these stay where
/// they are, and before all particles do. More: longer worst steps. Fewer: more motion is lost.
inline constexpr int kRetries = 2, kMostRetries = 16;

/// Neither side of a gap gets less than this fraction of it between planes [1]. Larger: what stands
/// takes more from what moves. Smaller: what stands is enclosed.
inline constexpr double kLeastPart = 0.05;

/// A vector is at most this many times as long as its largest component: the root of 3, rounded up
/// [1].
inline constexpr double kDiagonal = 1.7321;

/// Particles stop this much before their plane, as a fraction of their displacement [1]. Larger:
/// more motion is lost. Smaller: rounding could carry one over its plane.
inline constexpr double kStopShort = 1e-4;

/// Rounds in which pairs that were stopped take their approach from each other, at most, and the
/// fraction of the first round's largest impulse at which they end [1]. More: what is jammed leaves
/// less approach to the next step, which stops it again. Fewer: less work where much is stopped.
inline constexpr int kMostMeetings = 40;
inline constexpr double kMeetingResidual = 1e-3;

/// What is stopped has no more velocity back than takes it by this fraction of the finest mesh's
/// edges in a substep [1]: faster cloth that is crushed would go on for ticks, in which each
/// particle endangers a hundred pairs a substep. Larger: longer worst steps. Smaller: momentum is
/// lost at lower speeds.
inline constexpr double kMostBack = 0.4;

/// Steps in a row that stop a particle without taking its velocity [1]. More: what is jammed
/// between hands and objects presses on, and twice as much of its motion is lost. Fewer: two sheets
/// that hit each other in several steps lose momentum.
inline constexpr int kMostInARow = 6;

// Tangles.

/// What touched is apart once its gap is more than this many roundings of its particles'
/// coordinates [1]: cloths that start in one plane, pulled off it by 1e-28 m, would change sides by
/// rounding. Larger: such cloths stay without a promise for longer.
inline constexpr double kRoundingsOfNoGap = 8;

/// A cloth is a hopeless tangle if it has more crossings than 1 / this of its particles, and more
/// than the second number: work would have no bound. Larger: slower steps while a cloth is
/// tangled. Smaller: cloths that could be drawn apart pass through everything instead.
inline constexpr std::size_t kHeapPart = 2, kFewCrossings = 600;

// Rows.

/// Rows are made for pairs whose gap exceeds the distance they keep by no more than this fraction
/// of the thickness, or than they approach in twice the time that rows last [1]. Larger: more rows
/// that never push. Smaller: contact begins with a jump.
inline constexpr double kRowMargin = 0.1;

/// Rows of a particle are made anew when it has moved by the first fraction of the thickness [1],
/// or after this time [s] by the second one: what rests keeps its rows, which turn with their
/// features. Larger: rows that are far off. Smaller: more rows are made anew.
inline constexpr double kRowMotion = 0.5, kRestMotion = 0.05, kLongestRows = 1.0 / 120;

/// All pairs are examined if more than 1 / this of the particles have moved [1]. Larger: the lists
/// of single particles are followed, in random order, for more of them.
inline constexpr std::size_t kManyMoved = 8;

/// No row is made for a gap beyond this fraction of the thickness [1]: enough that what comes fast
/// has one before it arrives, or else the regions would have to stop it. Larger: more rows.
inline constexpr double kRowReach = 2;

/// Edges keep this fraction of the thickness, so that particles and triangles respond first [1].
/// Larger: more rows of edges. Smaller: what meets edge on edge sinks in.
inline constexpr double kEdgeRadius = 0.85;

/// Features that are near in the fabric keep no more than this fraction of their distance there
/// [1]. Larger: contact resists the fabric's own stretch. Smaller: tight folds close.
inline constexpr double kFabricPart = 0.8;

/// A neighbour comes nearer to what a feature meets if the cosine between the way to it and the way
/// there is above this [1]. Larger: what slides over cells ahead of it is braked. Smaller: rounding
/// decides which of equally near features respond.
inline constexpr double kLeadsNearer = 0.02;

/// The same where the two push each other already: dropped at once, what the particle carries would
/// sink until edges carry it, rise again, and never rest [1].
inline constexpr double kStillNearest = 0.3;

/// Edges are nearly parallel if the sine between them is below this [1]. Larger: what meets fast,
/// edge on edge, is stopped by its certificate. Smaller: cloth that slides along itself is braked.
inline constexpr double kParallel = 0.2;

/// Part of its distance that is kept by a pair which carries only because it is jammed [1]: the
/// cloth beside it is nearer, and it slides past once it is free. Larger: folds that turn are
/// braked. Smaller: what sweeps leave under load closes the gap again.
inline constexpr double kJammedPart = 0.03;

/// A particle that passes over the border of a triangle keeps its impulses if the cosine between
/// both directions is above this [1]. Larger: they are lost on curved cloth. Smaller: they push
/// elsewhere.
inline constexpr double kSameWay = 0.99;

// Response.

/// Rows that push nothing rest until the next look unless their gap could close in this many times
/// that time [1]. Larger: more rows are swept. Smaller: a contact may begin a few steps late.
inline constexpr double kBusyApproach = 2;

/// Sweeps where cloths meet only each other, at most, and the part of the thickness that the next
/// substep may then still take from a gap [1]. What sweeps leave under load sinks in, and the push
/// that leads it out again does work that came from nowhere; and layers that hop so let what lies
/// on them slide, a dense one on a light one most. More, or smaller: slower steps under load.
inline constexpr int kMostSweeps = 5;
inline constexpr double kAloneResidual = 1e-4;

/// Space is cut anew into slabs after this many steps, before a look. Larger: slabs that no longer
/// have equally many particles. Smaller: more sorting.
inline constexpr int kStepsBetweenCuts = 64;

/// Push-out: fraction of the lack per second [1/s], and its largest speed [m/s]. Larger: overlaps
/// close sooner, and do more work on what is pressed. Smaller: layers stay too near for longer.
inline constexpr double kPushRate = 60, kPushSpeed = 0.1;

/// Copying one particle by its number costs as much as this many in order [1].
inline constexpr std::size_t kCostOfOne = 2;

}  // namespace weft
