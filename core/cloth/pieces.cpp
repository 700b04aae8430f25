// Finds connected pieces by union and find.

#include "core/cloth/pieces.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace weft {

std::vector<Index> pieces_along(const std::vector<Edge>& edges, std::size_t particles) {
  std::vector<Index> first(particles);
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](Index i) {
    assert(i >= 0 && static_cast<std::size_t>(i) < particles);
    for (;;) {
      Index& up = first[static_cast<std::size_t>(i)];
      if (up == i) return i;
      up = first[static_cast<std::size_t>(up)];
      i = up;
    }
  };
  for (const Edge& edge : edges) {
    const auto [low, high] = std::minmax({root(edge[0]), root(edge[1])});
    first[static_cast<std::size_t>(high)] = low;
  }
  for (Index& i : first) i = root(i);
  return first;
}

}  // namespace weft
