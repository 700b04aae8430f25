#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/types.h"

namespace weft {

/// Of each particle those that an edge joins to it.
class Neighbours {
 public:
  struct Neighbour {
    Index edge = kNone, particle = kNone;
  };

  Neighbours() = default;
  /// @param particles  how many there are
  /// @param edges      whose ends are below that; the order of each particle's neighbours
  Neighbours(std::size_t particles, const std::vector<Edge>& edges);

  std::span<const Neighbour> of(std::size_t particle) const {
    const auto first = static_cast<std::size_t>(first_[particle]),
               end = static_cast<std::size_t>(first_[particle + 1]);
    return {list_.data() + first, end - first};
  }

 private:
  std::vector<Index> first_;  ///< of each particle, in the list; and the list's end
  std::vector<Neighbour> list_;
};

}  // namespace weft
