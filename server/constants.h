#pragma once

#include <cstddef>

// The numbers that the server assumes about what work may cost. Ranges of options stand in
// options.h, of commands in proto/limits.h.

namespace weft::server {

/// Share of a tick's limit that work between two ticks may take [1]: 0.8 s with the default limit,
/// so that no command waits a second for it. Larger: commands wait longer. Smaller: queries for the
/// contacts of large scenes are refused.
inline constexpr double kBetweenTicks = 0.4;

/// Longest mesh message [bytes], which everyone who joins is sent: 9 s at 30 Mbit/s. All cloth of
/// the largest scene takes 18 MB. Larger: joining a scene of many meshes takes longer. Smaller:
/// fine meshes are refused.
inline constexpr std::size_t kMostMeshBytes = std::size_t{32} << 20U;

}  // namespace weft::server
