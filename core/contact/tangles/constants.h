#pragma once

// The numbers that drawing tangles apart assumes.

namespace weft {

// Speeds.

/// Speed at which edge and triangle are pulled past each other [m/s]. Larger: tangles come undone
/// sooner, and the cloth flies apart. Smaller: they last longer, and weaken with kDrawPatience.
inline constexpr double kDrawSpeed = 0.5;

/// Speed at which a pucker is pulled flat [m/s]. Larger: it wanders instead. Smaller: it takes
/// longer.
inline constexpr double kUnfoldSpeed = 0.05;

/// Largest acceleration for these speeds, such as that of a fold pulled through by its rim alone
/// [m/s^2]. Larger: a stronger pull on the few particles at a contour. Smaller: heavy folds stay
/// through.
inline constexpr double kMostDrawAcceleration = 2000;

/// A tangle that lasts longer may be held by pins: its acceleration is divided by 1 + (t / this)^4
/// [s]. Larger: what cannot come undone is pulled for longer. Smaller: slow tangles are given up.
inline constexpr double kDrawPatience = 4;

// Work.

/// Sweeps over the rows per step. More: neighbouring crossings reach their speeds more exactly, in
/// proportionally more time.
inline constexpr int kDrawSweeps = 2;

// Sides.

/// Added to the area of a part that has held particles, to compare sizes [m^2]: far more than a
/// cloth of everyday size. Smaller, below a cloth's area: a part that is held may be taken to be on
/// the wrong side.
inline constexpr double kHeldPartArea = 1e3;

}  // namespace weft
