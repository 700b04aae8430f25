#pragma once

#include <cstddef>

// The numbers that all of contact shares.

namespace weft {

/// Closer pairs are separated by the best of several axes, computed in double [m]. Larger: more
/// pairs take that slower path. Smaller: closest points in float lose their direction to rounding,
/// and the certified gap of a pair is too small.
inline constexpr double kCloseGap = 3e-4;

/// An edge whose nearest point lies within this fraction of an end leaves contact to the particle
/// there [1]. Larger: edges that cross near their ends respond late. Smaller: an edge and its end
/// respond to the same contact.
inline constexpr double kEdgeEnd = 0.01;

/// Gap that every step leaves between features, and the same in units of the rounding of the
/// largest coordinate [m], [1]. Larger: layers stop farther apart. Smaller: the sign of a gap is
/// lost in rounding.
inline constexpr double kSmallestGap = 1e-5, kRoundings = 64;

/// Sweeps are repeated while one changes a displacement by more than this fraction of the thickness
/// [1]. Larger: what they leave is stopped by the certificates. Smaller: more sweeps.
inline constexpr double kResidual = 0.01;

/// What is nearer than this many times the distance that contact keeps touches, as it is told to
/// others [1]. Larger: contacts without force are told too.
inline constexpr double kTouching = 1.05;

/// Chunks of the pass that measures how far particles have come, on several threads; with fewer
/// particles than this one thread does it. More chunks: more threads, and more waiting for each
/// other. Fewer particles: threads cost more than they save.
inline constexpr std::size_t kTravelChunks = 4, kLeastSharedTravel = 4096;

}  // namespace weft
