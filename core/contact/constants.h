#pragma once

#include <cstddef>

// The numbers that all of contact shares.

namespace weft {

/// Closer pairs are separated by the best of several axes, computed in double [m]. Larger: more
/// pairs take that slower path. Smaller: closest points in float lose their direction to rounding,
/// and the certified gap of a pair is too small.
inline constexpr double kCloseGap = 3e-4;

/// Chunks of the pass that measures how far particles have come, on several threads; with fewer
/// particles than this one thread does it. More chunks: more threads, and more waiting for each
/// other. Fewer particles: threads cost more than they save.
inline constexpr std::size_t kTravelChunks = 4, kLeastSharedTravel = 4096;

}  // namespace weft
