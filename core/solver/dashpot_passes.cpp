// Instants of a tick at which the dashpots of bending act.

#include "core/solver/dashpot_passes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/instantiate.h"
#include "core/solver/constants.h"

namespace weft {
namespace {

/// Ends t of the passes of a group, as parts of its time [1]. With the shares d = 0.247, 0.325 and
/// 0.428, what swings m half times in a group loses 1 + s of the law's energy, s within
/// +-|sum d exp(2 pi i m t)| by its phase: 0.17 for m = 1, 0.46 for 2, at most 0.76 up to 8.
constexpr std::array<double, 3> kEnds = {0.247, 0.572, 1};
constexpr int kGroup = static_cast<int>(kEnds.size());

/// End of pass number k as a part of the tick [1].
double end_of(int k, const DashpotPasses& passes) {
  assert(k >= 0 && k < passes.count && (passes.even || passes.count % kGroup == 0));
  if (passes.even) return (k + 1.0) / passes.count;
  return (k / kGroup + kEnds[static_cast<std::size_t>(k % kGroup)]) * kGroup / passes.count;
}

}  // namespace

template <class Real>
DashpotPasses dashpot_passes(const ClothPart<Real>& part, double seconds) {
  assert(seconds > 0);
  const double fastest = std::min(std::sqrt(part.bounds.bending_omega2), kFastestBending);
  const int even = std::max(1, static_cast<int>(std::ceil(fastest * seconds / kMostBetweenPasses)));
  if (even <= kGroup) return {even, true};
  return {kGroup * std::max(1, static_cast<int>(std::ceil(seconds / kGroupSeconds))), false};
}

SubstepRange next_range(const SubstepRange& range, const DashpotPasses& passes) {
  assert(passes.count >= 1 && range.end < range.all);
  for (int k = 0; k < passes.count; ++k) {
    const int end = static_cast<int>(std::lround(range.all * end_of(k, passes)));
    if (end > range.end) return {range.end, end, range.all};
  }
  return {range.end, range.all, range.all};
}

double longest_share(const DashpotPasses& passes) {
  double longest = 0, before = 0;
  for (int k = 0; k < passes.count; ++k) {
    longest = std::max(longest, end_of(k, passes) - before);
    before = end_of(k, passes);
  }
  return longest;
}

WEFT_INSTANTIATE_FUNCTIONS(dashpot_passes)

}  // namespace weft
