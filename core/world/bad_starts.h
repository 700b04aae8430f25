#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/types.h"

namespace weft {

/// A cloth and what it passes through: itself, another cloth, or an object.
struct Meeting {
  Index cloth = 0;
  Index other = kNone;     ///< cloth, the same for itself; kNone: an object
  Index collider = kNone;  ///< the object
  std::size_t count = 0;   ///< of edges through triangles, or of triangles in a round object

  /// Whether the same two meet.
  bool is_of(const Meeting& m) const {
    return cloth == m.cloth && other == m.other && collider == m.collider;
  }
};

/// What nothing is promised about, because it started where it should not be.
struct BadStarts {
  std::vector<std::string> what;  ///< in words, e.g. "sheet started inside ball"
  /// Particles inside objects, and pairs of features of cloths that cross or touch, with those
  /// around them; of what else passes through each other, the crossings.
  std::size_t pairs = 0;
};

/// What a start that was looked at has: also in numbers, and what contact does not keep apart too.
struct ComingStarts : BadStarts {
  std::vector<Meeting> meetings;
};

}  // namespace weft
