#pragma once

#include <algorithm>
#include <string_view>

#include "proto/limits.h"

namespace weft::proto {

/// The room of the plain address `/ws`; it is always there.
inline constexpr const char* kDefaultRoom = "default";

/// Whether a room may have this name: 1 to 32 lower-case letters, digits and hyphens, the first one
/// no hyphen.
inline bool is_room_name(std::string_view text) {
  const auto fits = [](char x) {
    return (x >= 'a' && x <= 'z') || (x >= '0' && x <= '9') || x == '-';
  };
  return !text.empty() && text.size() <= kMostRoomNameBytes && text.front() != '-' &&
         std::all_of(text.begin(), text.end(), fits);
}

}  // namespace weft::proto
