#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/ranges.h"

// Limits that are part of weft.v1; ranges that core checks too are in core/ranges.h. Those of a
// server (viewers, rates) are in `Limits` of events.h.

namespace weft::proto {

inline constexpr const char* kSubprotocol = "weft.v1";

inline constexpr std::size_t kMostMessageBytes = std::size_t{64} * 1024;
inline constexpr std::size_t kMostDepth = 8;                 ///< of nested arrays and objects
inline constexpr double kLargestInteger = 9007199254740992;  ///< 2^53
inline constexpr Range kIndexRange{0, 2147483647};           ///< particles, triangles, own drags
inline constexpr Range kIdRange{0, 4294967295};              ///< viewers, pins
inline constexpr double kLeastDirection = 1e-9;              ///< of its largest component
inline constexpr Range kUnitRange{-1, 1};                    ///< components of a unit quaternion
inline constexpr double kUnitTolerance = 1e-3;               ///< of its norm
inline constexpr Range kMoveSecondsRange{1e-3, 3600};        ///< duration of a pin's motion [s]
inline constexpr Range kWeightRange{0, 1};                   ///< barycentric weights
inline constexpr double kWeightSumTolerance = 1e-3;
inline constexpr Range kFovRange{1, 179};         ///< [degrees]
inline constexpr Range kStepRange{1, 600};        ///< [ticks]
inline constexpr Range kAdvanceRange{1, 100000};  ///< [ticks]
inline constexpr Range kSpeedRange{0.01, 10};
inline constexpr Range kFrameRateRange{0, 240};     ///< [1/s]
inline constexpr Range kPackedErrorRange{1e-5, 1};  ///< [m]
/// Bounds of the error of packed frames. A viewer gets the largest that is neither above what it
/// allows nor above the usual one, and a larger one only while it does not keep up.
inline constexpr std::array<double, 3> kPackedErrors = {1e-5, 1e-4, 4e-4};  ///< [m]
inline constexpr double kUsualPackedError = kPackedErrors[1];               ///< [m]
inline constexpr Range kLevelRange{0, 255};
inline constexpr std::size_t kMostTreeBytes = 80;  ///< of the name of a tree

inline constexpr std::size_t kMostIdBytes = 64;
inline constexpr std::size_t kMostNameCharacters = 32;
inline constexpr std::size_t kMostTokenBytes = 256;
inline constexpr std::size_t kMostSceneBytes = 64;
inline constexpr std::size_t kMostGripperBytes = 56;
inline constexpr std::size_t kMostRoomNameBytes = 32;
inline constexpr std::size_t kMostValueCharacters = 80;  ///< of a string quoted in an error

}  // namespace weft::proto
