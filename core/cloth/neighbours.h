#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "core/types.h"

// Neighbourhood of particles along edges.

namespace weft {

/// The particles joined to each particle by an edge.
class Neighbours {
 public:
  struct Neighbour {
    Index edge = kNone, particle = kNone;
  };

  Neighbours() = default;
  /// @param particles  their number
  /// @param edges      with ends below that; their order is that of each particle's neighbours
  Neighbours(std::size_t particles, const std::vector<Edge>& edges);

  std::span<const Neighbour> of(std::size_t particle) const {
    assert(particle + 1 < first_.size());
    const auto first = static_cast<std::size_t>(first_[particle]),
               end = static_cast<std::size_t>(first_[particle + 1]);
    return {list_.data() + first, end - first};
  }

 private:
  std::vector<Index> first_;  ///< of each particle in the list; then the list's end
  std::vector<Neighbour> list_;
};

}  // namespace weft
