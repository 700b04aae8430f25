#pragma once

#include <vector>

#include "core/types.h"

// Order in which the particles of a cloth are eliminated.

namespace weft {

/// For each particle the others that the matrix couples it with, ascending.
using CouplingLists = std::vector<std::vector<Index>>;

/// Nested dissection (George 1973): halves of the cloth come before the particles that part them,
/// and so on within the halves. A sheet of n particles then fills its factor with some n log n
/// blocks; eliminated row by row, n^(3/2).
/// @param places  by which it is halved, across its longer extent
/// @returns       the particles in the order of their elimination
std::vector<Index> dissect(const CouplingLists& coupled, const Vec3Array<double>& places);

}  // namespace weft
