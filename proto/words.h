#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "proto/commands.h"

// Words on the wire, in the order of their enumerations.

namespace weft::proto {

inline constexpr std::array<const char*, 18> kQueryWhatWords = {
    "positions", "velocities",   "energies", "strain",    "pins",     "grabs",
    "camera",    "roster",       "state",    "work",      "trees",    "boxes",
    "colliders", "measurements", "contacts", "reactions", "grippers", "crossings"};
inline constexpr std::array<const char*, 3> kQueryFormatWords = {"json", "f32", "f64"};
inline constexpr std::array<const char*, 2> kCodecWords = {"f32", "packed"};

enum class DragPhase : std::uint8_t { start, move, end };
inline constexpr std::array<const char*, 3> kDragPhaseWords = {"start", "move", "end"};

inline constexpr std::array<const char*, 2> kDragModeWords = {"live", "sling"};
inline constexpr std::array<const char*, 2> kOverBudgetWords = {"slow", "soften"};

inline constexpr std::array<const char*, 3> kAdvanceFramesWords = {"none", "last", "all"};

template <std::size_t N>
std::vector<std::string> list_words(const std::array<const char*, N>& words) {
  return {words.begin(), words.end()};
}

}  // namespace weft::proto
