#pragma once

// The numbers that the motion of objects assumes. The limits of a command stand beside its struct
// in collider_motion.h.

namespace weft {

// Definitions.

/// Deviation from norm 1 of a quaternion in a definition or command: rounding to three digits [1].
/// Larger: a quaternion with a wrong component may pass. Smaller: written ones need more digits.
inline constexpr double kUnitQuaternionSlack = 1e-3;

/// Poses nearer than this are equal: rounding in a file [m], [rad]. It decides whether the last
/// keyframe of a loop is the first pose again. Larger: a loop may jump by as much. Smaller: files
/// need more digits.
inline constexpr double kSamePose = 1e-6;

// Ticks.

/// Fraction of a tick that its substeps may lack by rounding [1]: an object then has its planned
/// pose exactly. Larger, by a substep's fraction: it arrives early. Smaller, below the rounding: it
/// ends each tick near its pose, and the errors add up.
inline constexpr double kTickEndSlack = 1e-6;

/// A collider that was held back follows its keyframes faster than their top speed by this factor
/// [1]. Larger: it is back on its keyframes sooner, and pushes cloth faster. At 1 or below it never
/// catches up with keyframes of constant speed.
inline constexpr double kColliderCatchUp = 1.25;

// Resistance of cloth.

/// Fraction of its speed that a collider regains in a second without resistance [1/s]. Larger: it
/// starts sooner, and a collider at its limit varies its speed more. Smaller: it yields for longer
/// after the resistance has ended.
inline constexpr double kPaceGain = 6;

/// Time in which resistance beyond its force slows a collider to where the force would do, if
/// resistance goes with speed [s]. Larger: it presses beyond its force for longer. Smaller: one
/// impact stops it.
inline constexpr double kPaceSeconds = 1.0 / 60;

/// Below this fraction of its speed a collider that is resisted stands [1]. Larger: it stops sooner
/// before cloth that resists. Smaller: it creeps on.
inline constexpr double kLeastColliderPace = 0.01;

/// Speed at which an object yields to twice its force, and in proportion to more and less [m/s].
/// Larger: it lets go of layers for moments. Smaller: it presses too hard for longer.
inline constexpr double kYieldSpeed = 0.01;

/// Most times that speed [1]. Larger: what was jammed for a moment throws it back. Smaller: layers
/// that ruck up under it are crushed.
inline constexpr double kMostYielding = 10;

/// An object that yields at this speed does not move along what resists [m/s], at less it does in
/// part. Larger: it drags layers on that jam under it. Smaller: it sticks where it presses with its
/// force.
inline constexpr double kOnlyYields = 0.005;

/// Speed at which an object that has yielded goes back at first [m/s]. Larger: it misses its
/// force by more on stiff layers. Smaller: it finds it later.
inline constexpr double kTurningSpeed = 2e-4;

/// Growth of the speed of an object that goes back, in `kPaceSeconds` [1]: it meets what it has
/// yielded to at a speed in proportion to how far it has yielded, and so each time more softly.
/// Larger: it overshoots its force. At 1 it never gains speed.
inline constexpr double kPaceGrowth = 1.15;

/// Resistance beyond the force for a shorter time is an impact [s]: its impulse leaves the force no
/// time to act. Larger: a collider drives deeper into a pile before it is held. Smaller: light
/// touches hold it.
inline constexpr double kImpactSeconds = 1e-3;

/// The same of a gripper that holds cloth, whose inertia it meets at the start of each tick that is
/// faster than the last [s]. Larger: it drives what it holds deeper into what it meets. Smaller: it
/// stands before what it could carry.
inline constexpr double kGripImpactSeconds = 6e-3;

/// An object presses a layer if its goal lies at least so far behind it [m].
inline constexpr double kPressingDepth = 1e-6;

/// An object goes on pressing in the direction in which it does while the cosine between that and
/// the new one lacks no more than this of 1 [1]. Larger: along a curve it turns by jerks. Smaller,
/// below rounding: it slips to and fro over the layer.
inline constexpr double kSameDirection = 1e-5;

/// Most that is remembered of an overload, in impulses of an impact [1]. Larger: a collider stays
/// held for longer after a hard hit. At 1 or below nothing holds it.
inline constexpr double kMostOverload = 4;

}  // namespace weft
