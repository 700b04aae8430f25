#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace weft {

/// A row of elements of one kind whose particle indices all advance by the same stride: element n
/// of the run joins the particles first[0] + n stride, ..., first[N-1] + n stride. Loops over a run
/// have no index look-ups, so compilers turn them into vector code. A grid cloth is made of long
/// runs; on a mesh without any order each element is a run of its own.
template <int N>
struct Run {
  std::array<Index, static_cast<std::size_t>(N)> first = {};
  Index stride = 1;
  Index count = 0;
  Index element = 0;  ///< an element of the run, which lends its parameters to all of them
};

/// Groups elements into runs of equal parameters.
///
/// @param elements  corner particles of each element
/// @param group     elements with the same group number have the same parameters
/// @return runs ordered by their first particle, each element in exactly one of them
template <int N>
std::vector<Run<N>> group_into_runs(
    const std::vector<std::array<Index, static_cast<std::size_t>(N)>>& elements,
    const std::vector<std::uint32_t>& group);

}  // namespace weft
