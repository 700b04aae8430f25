// Measures and counts the displacements of a step.

#include "core/contact/guard/guarded_step.h"

#include <cassert>
#include <utility>

#include "core/instantiate.h"

namespace weft {

template <class Real>
void measure_lengths(GuardedStep<Real>& step) {
  if (std::exchange(step.measured, step.number) == step.number) return;
  for (std::size_t i = 0; i < step.displacement.size(); ++i)
    step.length[i] = length(step.displacement[i]);
}

template <class Real>
void count_motion(const std::vector<Index>& active, GuardedStep<Real>& step, GuardCounts& counts) {
  step.allowed = 0;
  for (const Index k : active)
    step.allowed += static_cast<double>(length(step.displacement[at_index(k)]));
  counts.truncated += step.lost;
  counts.wanted += step.allowed + step.lost;
  step.lost = 0;
}

template <class Real>
void halt(const std::vector<char>& is_active, GuardedStep<Real>& step, Vec3Array<Real>& x,
          Vec3Array<Real>& v) {
  assert(x.size() == step.from.size() && v.size() == x.size());
  for (std::size_t i = 0; i < step.displacement.size(); ++i) {
    if (is_active[i]) step.lost += static_cast<double>(length(step.displacement[i]));
    step.displacement[i] = {};
    x[i] = to_vector(step.from[i]);
    v[i].setZero();
  }
}

WEFT_INSTANTIATE_FUNCTIONS(measure_lengths, count_motion, halt)

}  // namespace weft
