#include "core/contact/guard/pair_separation.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/guard/pair_separation.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/guard/pair_separation-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {
namespace {

/// Pairs of a block that is worth a thread's while: whole vectors.
constexpr std::size_t kBlock = 64 * kPairPadding;

/// Calls separate(first, last) for all pairs, in blocks if there are threads.
template <class Separate>
void for_blocks(std::size_t pairs, Executor* executor, Separate&& separate) {
  if (!executor || pairs <= kBlock) {
    separate(0, pairs);
    return;
  }
  run_chunks(executor, static_cast<int>((pairs + kBlock - 1) / kBlock), [&](int chunk) {
    const std::size_t first = kBlock * static_cast<std::size_t>(chunk);
    separate(first, std::min(first + kBlock, pairs));
  });
}

template <class Real>
const Real* numbers_of(const QuadArray<Real>& quads) {
  return reinterpret_cast<const Real*>(quads.data());
}

}  // namespace

template <class Real>
void PairColumns<Real>::make_room() {
  const std::size_t room = std::max(2 * a.size(), 8 * kPairPadding);
  for (std::vector<Index>* column :
       {&a, &b, &particle[0], &particle[1], &particle[2], &particle[3]})
    column->resize(room, 0);
  for (std::vector<Real>* column : {&gap, &end_gap, &normal[0], &normal[1], &normal[2], &weight[0],
                                    &weight[1], &weight[2], &weight[3]})
    column->resize(room, 0);
}

template <class Real>
PairSeparation<Real> PairColumns<Real>::separation(std::size_t k, const QuadArray<Real>& x) const {
  if (!(gap[k] > static_cast<Real>(kCloseGap))) {
    PairPoints<Real> points;
    for (std::size_t n = 0; n < 4; ++n) points[n] = to_vector(x[at_index(particle[n][k])]);
    return separate_pair(kind, points);
  }
  PairSeparation<Real> s;
  s.gap = gap[k];
  for (int n = 0; n < 3; ++n) s.normal[n] = normal[at_index(n)][k];
  for (std::size_t n = 0; n < 4; ++n) s.weight[n] = weight[n][k];
  const auto between = [](Real t) {
    return t > static_cast<Real>(kEdgeEnd) && t < static_cast<Real>(1 - kEdgeEnd);
  };
  s.inside = kind == PairKind::vertex_triangle
                 ? s.weight[1] < 0 && s.weight[2] < 0 && s.weight[3] < 0
                 : between(s.weight[1]) && between(-s.weight[3]);
  return s;
}

WEFT_EXPORT_KERNEL(separate);

template <class Real>
void separate_pairs(const QuadArray<Real>& x, const QuadArray<Real>& end, PairColumns<Real>& pairs,
                    Executor* executor) {
  for_blocks(pairs.size(), executor, [&](std::size_t first, std::size_t last) {
    WEFT_RUN(separate, Real)(numbers_of(x), numbers_of(end), first, last, pairs);
  });
}

WEFT_INSTANTIATE_FUNCTIONS(separate_pairs)
template struct PairColumns<float>;
template struct PairColumns<double>;

}  // namespace weft
#endif
