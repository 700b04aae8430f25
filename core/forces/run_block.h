#pragma once

#include "core/cloth/particle_fields.h"
#include "core/cloth/runs.h"
#include "core/types.h"

namespace weft {

/// Runs are worked through in blocks whose intermediate values stay in the first-level cache.
inline constexpr Index kRunBlock = 64;

/// Components of one corner of a block's elements, read with the run's stride.
template <class Real>
struct BlockReader {
  const Real *x, *y, *z;

  BlockReader(const ParticleFields<Real>& fields, Index first)
      : x(fields.x.data() + first), y(fields.y.data() + first), z(fields.z.data() + first) {}
};

/// A vector for each element of a block.
template <class Real>
struct BlockValues {
  Real x[kRunBlock], y[kRunBlock], z[kRunBlock];
};

/// force[first + n stride] += sign * values[n], for the elements of a block.
template <class Real>
inline void add_block(const BlockValues<Real>& values, Index count, Index first, Index stride,
                      Real sign, ParticleFields<Real>& force) {
  Real* const fx = force.x.data() + first;
  Real* const fy = force.y.data() + first;
  Real* const fz = force.z.data() + first;
  if (stride == 1) {
    for (Index n = 0; n < count; ++n) fx[n] += sign * values.x[n];
    for (Index n = 0; n < count; ++n) fy[n] += sign * values.y[n];
    for (Index n = 0; n < count; ++n) fz[n] += sign * values.z[n];
    return;
  }
  for (Index n = 0; n < count; ++n) {
    fx[n * stride] += sign * values.x[n];
    fy[n * stride] += sign * values.y[n];
    fz[n * stride] += sign * values.z[n];
  }
}

/// Calls `work(offset of the first particle, count)` for each block of a run.
template <int N, class Work>
inline void for_each_block(const Run<N>& run, Work&& work) {
  for (Index done = 0; done < run.count; done += kRunBlock) {
    const Index left = run.count - done;
    work(done * run.stride, left < kRunBlock ? left : kRunBlock);
  }
}

}  // namespace weft
