#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

namespace weft::server {

struct StrainStatistics {
  double largest = 0;  ///< of |l - L| / L over structural and shear springs
  double p99 = 0;      ///< 99 of 100 springs have less
};

/// @param scratch  keeps its capacity from call to call
template <class Real>
StrainStatistics strain_statistics(const ClothModel<Real>& model, const ClothState<Real>& state,
                                   std::vector<Real>& scratch) {
  scratch.clear();
  for (std::size_t s = 0; s < model.springs.size(); ++s) {
    if (model.spring_kinds[s] == SpringKind::skip) continue;
    const Spring<Real>& spring = model.springs[s];
    const Real length =
        (state.x[static_cast<std::size_t>(spring.j)] - state.x[static_cast<std::size_t>(spring.i)])
            .norm();
    scratch.push_back(std::abs(length - spring.rest_length) / spring.rest_length);
  }
  if (scratch.empty()) return {};
  const auto p99 = scratch.begin() + static_cast<std::ptrdiff_t>((scratch.size() - 1) * 99 / 100);
  std::nth_element(scratch.begin(), p99, scratch.end());
  return {static_cast<double>(*std::max_element(p99, scratch.end())), static_cast<double>(*p99)};
}

}  // namespace weft::server
