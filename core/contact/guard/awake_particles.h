#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/math/quad.h"
#include "core/types.h"

// Which cloths the guard need not examine between each other, because they sleep.

namespace weft {

/// Particles of the cloths that are awake.
struct AwakeParticles {
  std::vector<IndexRange> ranges;  ///< one for each such cloth
  std::size_t count = 0;           ///< of particles
  std::vector<char> resting;       ///< 1 for each patch of a cloth that sleeps
};

/// Mean of value(i) over all particles that are awake.
template <class Real, class Value>
Quad<Real> mean_awake(const AwakeParticles& awake, Value&& value) {
  Quad<Real> sum;
  for (const IndexRange& range : awake.ranges) {
    for (Index i = range.first; i < range.end(); ++i) sum += value(at_index(i));
  }
  return sum * (Real(1) / static_cast<Real>(std::max<std::size_t>(awake.count, 1)));
}

}  // namespace weft
