#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/types.h"

// Starts with cloth inside objects or through cloth.

namespace weft {

/// A cloth and what it passes through: itself, another cloth, or an object.
struct Meeting {
  Index cloth = 0;
  Index other = kNone;     ///< cloth, the same for itself; kNone: an object
  Index collider = kNone;  ///< the object
  std::size_t count = 0;   ///< edges through triangles, or triangles in a round object

  /// Whether the same two meet.
  bool is_of(const Meeting& m) const {
    return cloth == m.cloth && other == m.other && collider == m.collider;
  }
};

/// Starts about which nothing is promised: features that began crossed or penetrated.
struct BadStarts {
  std::vector<std::string> what;  ///< in words, e.g. "sheet started inside ball"
  /// Particles inside objects, and pairs of cloth features that cross or touch, with their
  /// neighbourhoods; for other intersections, the crossings.
  std::size_t pairs = 0;
};

/// Starts found by looking ahead: also in numbers, including those that contact does not separate.
struct ComingStarts : BadStarts {
  std::vector<Meeting> meetings;
};

}  // namespace weft
