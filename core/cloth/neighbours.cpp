// Sorts edges into lists by particle.

#include "core/cloth/neighbours.h"

#include <cassert>

namespace weft {

Neighbours::Neighbours(std::size_t particles, const std::vector<Edge>& edges)
    : first_(particles + 1, 0), list_(2 * edges.size()) {
  for (const Edge& edge : edges) {
    for (const Index i : edge) {
      assert(i >= 0 && static_cast<std::size_t>(i) < particles);
      ++first_[static_cast<std::size_t>(i) + 1];
    }
  }
  for (std::size_t i = 0; i < particles; ++i) first_[i + 1] += first_[i];
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t k = 0; k < 2; ++k) {
      Index& place = next[static_cast<std::size_t>(edges[e][k])];
      list_[static_cast<std::size_t>(place++)] = {static_cast<Index>(e), edges[e][1 - k]};
    }
  }
}

}  // namespace weft
