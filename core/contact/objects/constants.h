#pragma once

#include <cstddef>

// The numbers that contact of cloth with objects assumes.

namespace weft {

// Clearances and candidates.

/// How far beyond the distance that matters a clearance is searched for [m]. Larger: more of a mesh
/// is examined. Smaller: cloth that comes nearer is measured at every step.
inline constexpr double kClearanceHorizon = 0.1;

/// Ticks of a particle's present motion for which candidates hold [1]. Larger: more candidates.
/// Smaller: more collections.
inline constexpr double kSkinTicks = 2.5;

/// Substeps of it for which they hold at least, however fast it is [1].
inline constexpr double kSkinSubsteps = 4;

/// A particle may go this many times as far as candidates were asked for, if it is known to be
/// clear [1]. Larger: far particles stay in the lists for longer.
inline constexpr double kMostSkin = 4;

/// Clearance of what sleeps [m]: no list ever has it.
inline constexpr double kOutOfReach = 1e9;

/// Squared distances may be taken for this fraction of what they are, where only a bound is wanted
/// [1]. Larger: more boxes of a mesh are opened. Smaller: looser bounds.
inline constexpr double kBoundSlack = 0.6;

/// Collections between two measurements of a particle that is near without having pairs. Larger:
/// particles that have left stay in the lists. Smaller: more measurements.
inline constexpr std::size_t kTurns = 8;

/// Parts of the collection. More: more threads, and more lists to join.
inline constexpr std::size_t kContactParts = 8;

/// Particles, features or pairs whose rows one thread makes, or particles whose clearance it takes
/// over, and particles whose reach it finds, at least. Fewer: to deal them out costs more than the
/// work.
inline constexpr std::size_t kMadeAtLeast = 512, kAllowedAtLeast = 1024;

/// How far around a patch its part of a mesh reaches, in sizes of the mesh's triangles [1]. Larger:
/// it is looked up less often, and more has to be measured.
inline constexpr double kNeighbourhoodMargin = 0.3;

/// Where nothing is near [m].
inline constexpr double kFarAway = 1000;

// Rows.

/// Substeps of a particle's present motion for which rows hold [1]. Among objects at rest it need
/// not go farther than this many thicknesses, or in long substeps for this few of them: where
/// particles may go far, edges and triangles need rows of their own.
inline constexpr double kRowSubsteps = 14, kRowThicknesses = 2, kFewSubsteps = 2;

/// Rows also hold for this fraction of a particle's distance from the next analytic shape [1].
inline constexpr double kFreePart = 0.4;

/// A particle that is pushed out may go this much farther than its reach, as a fraction of the
/// thickness [1]; more than a push does.
inline constexpr double kRoomForPush = 0.125;

/// Factor on bounds, for rounding [1].
inline constexpr double kSurely = 1.001;

/// Distances from the core of a round object may be off by this many times the rounding of its
/// radius [1].
inline constexpr double kCoreRoundings = 16;

/// Fraction of its thickness that a cloth keeps from a round object even if it is pressed on it
/// [1]. Larger: more rows of edges. Smaller: edges sink in.
inline constexpr double kKeptPart = 0.25;

/// A row responds only where its particles may touch, within this fraction of their distance [1]:
/// the response of other rows changes displacements. Larger: a contact may be noticed late.
inline constexpr double kTouchPart = 0.7;

// Cloth that starts inside an object.

/// Steps of the search for the surface, and the least length of one [m]. More, shorter: the surface
/// is found more exactly.
inline constexpr int kMostSurfaceSteps = 64;
inline constexpr double kLeastSurfaceStep = 1e-4;

/// Triangles whose mean normal is longer than the first lie alike; a direction counts if it is
/// longer than the second, as a fraction of what it could be [1].
inline constexpr double kAlike = 0.3, kDecided = 0.1;

// Response.

/// A row with a pinned particle does not respond if another one would have to move this many times
/// as far as its point [1]: the pin all but holds it, and what is pushed there would be thrown.
/// Larger: it is thrown. Smaller: cloth next to a pin lies nearer than its thickness.
inline constexpr double kMostLever = 4;

/// A gap this much wider than the thickness still counts as touching, so that rounding of positions
/// does not let a resting particle fall for a substep, and its friction with it [m]. Larger: cloth
/// rests farther off. Smaller: it trembles.
inline constexpr double kTouchSlack = 2e-5;

/// Push-out: fraction of the lack taken each substep [1]; its largest speed, and that of what is
/// inside an object [m/s]. Larger: overlaps close sooner, and cloth that is bent over edges or
/// hangs from what is pushed is stretched and thrown.
inline constexpr double kPushOutPart = 0.1, kPushOutSpeed = 0.05, kLeadOutSpeed = 0.5;

/// Sweeps of projected Gauss-Seidel over the rows.
inline constexpr int kSweeps = 2;

/// Further ones between jaws, at most, and the change of a velocity that they leave [m/s]. More
/// sweeps, or a smaller change: held cloth creeps less, and costs more.
inline constexpr int kJawSweeps = 20;
inline constexpr double kJawResidual = 1e-5;

/// The same where no jaw holds cloth, but objects press it on others. More: a finger that comes
/// fast shoves the cloth under it.
inline constexpr int kPressSweeps = 4;
inline constexpr double kPressResidual = 1e-4;

/// Further ones, each after one over the rows of cloths with each other: one where these press, as
/// piles would tremble without, and more while each changes more than kResidual. None where the
/// first one, begun from the impulses of the last step, found less than this to do [m/s].
inline constexpr int kMoreSweeps = 8;
inline constexpr double kStill = 5e-4;

/// Sweeps at the end of a tick over the rows of cloths with each other and with objects, in turn.
inline constexpr int kClosingSweeps = 4;

/// Slower impacts do not bounce [m/s]. Larger: cloth comes to rest sooner. Smaller: it rattles.
inline constexpr double kBounceSpeed = 0.05;

/// A row is in front of a jaw if the cosine between its normal and the direction of pressing is
/// above this [1].
inline constexpr double kFacing = 0.9;

/// Closed jaws grip what is nearer than the thickness and this fraction of it [1].
inline constexpr double kSqueezed = 0.02;

/// The same where layers resist the jaws, between which the outer ones shake [1]. Larger: jaws hold
/// what lies loose between them. Smaller: what shakes is let go of for moments, and creeps out.
inline constexpr double kSqueezedLayers = 0.3;

/// A particle carries a row if its weight is above this [1].
inline constexpr double kCarries = 0.1;

/// Jaws stand before a layer that they begin to pinch if they go into it faster than this [m/s].
/// Larger: they go on into it for a tick. Smaller: they stand where they only go along it.
inline constexpr double kIntoPinch = 2e-4;

/// Objects on both sides of a layer slip past each other if they do so faster than this [m/s].
inline constexpr double kSlips = 1e-6;

/// So many contacts of particles with a jaw hold the cloth alone [1]. Larger: more of the force
/// lies where jaws end. Smaller: cloth of large cells turns between them.
inline constexpr int kHoldAlone = 12;

/// What is nearer to a jaw than this many thicknesses is in front of it [1].
inline constexpr double kBeforeJaw = 1.6;

// Certificates.

/// Rounds of projection on violated planes before a particle is held. More: less motion is lost.
inline constexpr int kCertifyRounds = 3;

/// A particle is lifted this many times as far as its plane asks for, for rounding [1].
inline constexpr double kLiftSlack = 1.0001;

/// What a moving object leaves between itself and the cloth, as a fraction of the thickness [1];
/// more than one at rest, so that cloth in a pinch stops it before there is no room for rounding.
inline constexpr double kMoverGap = 0.25;

/// An object that cloth has stopped stands for this many further substeps, in which the cloth is
/// not pushed and can make way; and for the second number may be stopped again.
inline constexpr int kRest = 2, kWary = 16;

/// Rounding of a particle that is carried along [m].
inline constexpr double kCarrySlack = 1e-6;

}  // namespace weft
