#include "core/cloth/runs.h"

#include <algorithm>
#include <numeric>

namespace weft {
namespace {

/// Strides that a loop over a run handles well; 2 is the step between like cells of alternating
/// diagonals.
constexpr Index kLongestStride = 2;

}  // namespace

template <int N>
std::vector<Run<N>> group_into_runs(
    const std::vector<std::array<Index, static_cast<std::size_t>(N)>>& elements,
    const std::vector<std::uint32_t>& group) {
  using Corners = std::array<Index, static_cast<std::size_t>(N)>;
  const auto offsets = [&](Index e) {
    Corners c = elements[static_cast<std::size_t>(e)];
    for (std::size_t k = 1; k < c.size(); ++k) c[k] -= c[0];
    c[0] = 0;
    return c;
  };
  const auto first = [&](Index e) { return elements[static_cast<std::size_t>(e)][0]; };
  const auto group_of = [&](Index e) { return group[static_cast<std::size_t>(e)]; };
  std::vector<Index> order(elements.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (group_of(a) != group_of(b)) return group_of(a) < group_of(b);
    const Corners oa = offsets(a), ob = offsets(b);
    if (oa != ob) return oa < ob;
    return first(a) != first(b) ? first(a) < first(b) : a < b;
  });
  std::vector<Run<N>> runs;
  for (std::size_t n = 0; n < order.size();) {
    const Index e = order[n];
    Run<N> run;
    run.first = elements[static_cast<std::size_t>(e)];
    run.element = e;
    run.count = 1;
    const auto continues = [&](std::size_t next, Index stride) {
      return next < order.size() && group_of(order[next]) == group_of(e) &&
             offsets(order[next]) == offsets(e) &&
             first(order[next]) - first(order[next - 1]) == stride;
    };
    for (Index stride = 1; stride <= kLongestStride; ++stride) {
      if (!continues(n + 1, stride)) continue;
      run.stride = stride;
      while (continues(n + static_cast<std::size_t>(run.count), stride)) ++run.count;
      break;
    }
    n += static_cast<std::size_t>(run.count);
    runs.push_back(run);
  }
  std::sort(runs.begin(), runs.end(), [](const Run<N>& a, const Run<N>& b) {
    return a.first != b.first ? a.first < b.first : a.element < b.element;
  });
  return runs;
}

template std::vector<Run<2>> group_into_runs<2>(const std::vector<std::array<Index, 2>>&,
                                                const std::vector<std::uint32_t>&);
template std::vector<Run<3>> group_into_runs<3>(const std::vector<std::array<Index, 3>>&,
                                                const std::vector<std::uint32_t>&);
template std::vector<Run<4>> group_into_runs<4>(const std::vector<std::array<Index, 4>>&,
                                                const std::vector<std::uint32_t>&);

}  // namespace weft
