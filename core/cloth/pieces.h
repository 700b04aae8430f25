#pragma once

#include <cstddef>
#include <vector>

#include "core/types.h"

// Pieces that edges connect.

namespace weft {

/// The first particle of each particle's piece; a particle without an edge is one of its own.
std::vector<Index> pieces_along(const std::vector<Edge>& edges, std::size_t particles);

}  // namespace weft
