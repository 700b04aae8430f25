#pragma once

// The numbers that pins, hands and grippers assume. Their ranges and greatest numbers stand beside
// the structs that have them, in pins.h, grabs.h and gripper.h.

namespace weft {

/// Remaining distance of a pin or of a gripper's middle that is rounding [m]: it has arrived.
/// Larger: it stops that far from its target. Smaller, below rounding at the size of its
/// coordinates: it may never arrive.
inline constexpr double kArrivalDistance = 1e-9;

// Hands and slings.

/// Damping ratio of the hand's spring with the held mass, nothing pinned [1]. Larger: the held
/// point creeps to the hand. Smaller: it swings about it for longer.
inline constexpr double kGrabDampingRatio = 0.7;

/// v_max: no live hand moves the held cloth faster than this [m/s], and none leads it by more than
/// the cloth can follow in a tick at this speed. A target that jumps by metres is approached at
/// v_max, as if the hand pulled less. People fling a mouse at some 10 m/s, and robots stay below;
/// the remaining margin lets a hand of the default stiffness press with the default 50 N. Larger: a
/// strong hand throws its few grams at thousands of metres a second, and contact has to search the
/// whole scene along their paths. Smaller: hands that are well within their force lag.
inline constexpr double kFastestHeld = 30;

/// Shortest tick that counts for the lead [s]: shorter ticks do not weaken hands. Larger: a hand
/// may lead, and so pull, farther in one tick. Smaller: at high tick rates it presses with less
/// force.
inline constexpr double kLeadSeconds = 1.0 / 60;

/// Duration of a fired sling's force, rounded to ticks, at least one [s]. Larger: a slower throw of
/// more impulse. Smaller: its impulse goes to the few grams of the held disc before the surrounding
/// cloth can follow.
inline constexpr double kSlingSeconds = 0.1;

// Places of pins.

/// Fraction of the fabric's extent by which rounding may move a particle off its line [1]. Larger:
/// a strip takes particles beyond its width. Smaller: it misses particles on its line.
inline constexpr double kStripSlack = 1e-5;

/// Largest factor of the bending about the last held line of a strip [1]. Larger: the strip holds
/// one line less where its border lies nearly half a cell beyond one, and the stiff hinge takes
/// more substeps. Smaller: held lines lie farther beyond the border.
inline constexpr double kMostStiffening = 8;

/// A place that far beyond a border, in cells, is not held [1]: then the next particle inwards is
/// at most 1/2 - 1 / kMostStiffening of a cell within it.
inline constexpr double kMostBeyond = 0.5 + 1 / kMostStiffening;

/// Least radius of a disc that clamps at its circle, in cells [1]. Larger: smaller discs hold by
/// the cell. Smaller: few lines make the circle, and what should turn about a point is clamped.
inline constexpr double kLeastClampedDisc = 3;

/// Factors are multiples of one part in this many [1]. Larger: sums of the weights of single
/// precision, 40 at most, no longer cancel, and a clamp pulls with a force that grows with the
/// distance from the origin. Smaller: clamps lie off their places.
inline constexpr double kStiffeningParts = 4096;

// Motion of pins.

/// At the start and the end of a motion [m/s^2]. Larger: short motions take less time, and pull
/// harder. Smaller: a pin takes longer than its speed allows.
inline constexpr double kPinAcceleration = 40;

/// A pin farther than this from its particles restarts from them, and leads them by this much [m].
/// Larger: it drags the cloth for longer before it counts as behind. Smaller: it restarts at every
/// light resistance, and pulls less.
inline constexpr double kPinSlack = 0.005;

/// Lagging particles catch up at no more than this multiple of the pin's speed [1]. Larger: faster
/// jerks when an obstacle lets go. At 1 they do not catch up with a pin at full speed.
inline constexpr double kPinCatchUp = 1.5;

/// Largest distance of a particle from its place at which a pin has arrived [m], and the same in
/// roundings of its position [1], if that is more. Larger: particles are fixed off their places.
/// Smaller: a pin that carries a load takes longer to arrive.
inline constexpr double kPinArrived = 1e-5, kPinRoundings = 4;

/// A moved pin rests for one tick before it is fixed, and one more tick is lost to rounding
/// [ticks]. Larger: estimated times are too long. Smaller: moves with a given time arrive late.
inline constexpr double kPinTicksAtTarget = 2;

// Grippers.

/// Below this opening, in thicknesses of cloth [1], jaws close by at most kJawNearStep of the
/// thickness per tick, so that they stop at the cloth and not inside it. Larger: they close slowly
/// for longer. Smaller, below the cloth between them: they run into it at full speed.
inline constexpr double kJawNearOpening = 6;

/// That step, as a fraction of the thickness of the thickest cloth [1]. Larger: jaws stop deeper in
/// the cloth. Smaller: they take longer to grip.
inline constexpr double kJawNearStep = 0.25;

/// By how much jaws that cloth resists with twice their force open in a tick, as a fraction of the
/// thickness of the thickest cloth, and in proportion to more and less [1]. Larger: they let go of
/// layers for moments. Smaller: they press too hard for longer.
inline constexpr double kJawYield = 0.02;

/// Most times that [1]. Larger: they throw open what was jammed for a moment. Smaller: they crush
/// what bunches between them.
inline constexpr double kMostJawYield = 3;

/// Jaws that have yielded come back with this fraction of kJawYield at first, and faster by this
/// factor with each tick [1]. Larger: they miss their force by more. Smaller: they find it later.
inline constexpr double kJawTurning = 0.01, kJawGrowth = 1.1;

/// Least force over which an excess counts as a fraction [N]. Larger: jaws of less force yield more
/// slowly. At 0 those without force would divide by it.
inline constexpr double kLeastGrip = 0.01;

/// Jaws touch the cloth between them when their opening exceeds its thickness by no more than this
/// fraction [1]: rounding. Smaller: jaws that stop exactly at the cloth may count as still open.
inline constexpr double kJawFacingSlack = 1e-6;

/// How far jaws that stand draw back in a tick to close, in thicknesses of the thickest cloth [1].
/// Larger: they lose touch of what they were pressed on. Smaller: they take longer to get free.
inline constexpr double kJawRetreat = 0.02;

/// How far jaws draw back from cloth that they hold and that jams under them, in thicknesses of the
/// thickest cloth [1]. Larger: they tremble before it. Smaller: it stays jammed.
inline constexpr double kJamRetreat = 0.1;

/// Jaws press layers in one direction if those of both are alike: if the cosine between them is
/// above this [1]. Larger: astride a rod they rock. Smaller: in a corner they slide along it.
inline constexpr double kAlikePinches = 0.5;

/// Jaws that stand on a layer on another object press it if their goal lies so far behind it, as a
/// part of the way there [1]. Larger: they glide along where they are meant to press. Smaller: jaws
/// that are moved along a layer press it because of its small slopes.
inline constexpr double kPressingSlope = 0.05;

/// Jaws that one layer resists with more than their force yield to it until it resists with this
/// fraction of that [1]. Larger: they change their minds. Smaller: they go on yielding to rims.
inline constexpr double kJawLeaves = 0.3;

}  // namespace weft
