#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/parts.h"
#include "core/executor.h"

// Passes over the particles of all cloths that are awake, in parts of about the same size, however
// few particles each cloth has.

namespace weft {

/// Calls work(cloth, first, last) for consecutive particles of each cloth that is awake, in parts
/// on several threads.
/// @param at_least  particles of a part
/// @param executor  may be null
/// @return whether any call returned true
template <class Real, class Work>
bool any_of_awake(const ClothModel<Real>& model, const ClothState<Real>& state,
                  std::size_t at_least, Executor* executor, Work&& work) {
  const std::size_t particles = state.x.size();
  std::array<bool, kMostParts> found{};
  const auto look = [&](std::size_t number, std::size_t first, std::size_t last) {
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      const IndexRange& range = model.parts[p].particles;
      const std::size_t from = std::max(first, static_cast<std::size_t>(range.first));
      const std::size_t to = std::min(last, static_cast<std::size_t>(range.end()));
      if (from < to && !state.is_asleep(p)) found[number] |= work(p, from, to);
    }
  };
  run_parts(executor, particles, executor ? parts_of(particles, at_least) : 1, look);
  return std::find(found.begin(), found.end(), true) != found.end();
}

}  // namespace weft
