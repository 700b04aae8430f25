#pragma once

#include <algorithm>
#include <vector>

#include "core/types.h"

namespace weft {

/// A vector for each particle, component by component, as the force loops want it.
template <class Real>
struct ParticleFields {
  std::vector<Real> x, y, z;

  void resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    z.resize(n);
  }
  void set_zero() {
    for (std::vector<Real>* component : {&x, &y, &z})
      std::fill(component->begin(), component->end(), Real(0));
  }
  void copy_from(const Vec3Array<Real>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      x[i] = values[i][0];
      y[i] = values[i][1];
      z[i] = values[i][2];
    }
  }
  Vec3<Real> at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void add(std::size_t i, const Vec3<Real>& value) {
    x[i] += value[0];
    y[i] += value[1];
    z[i] += value[2];
  }
};

}  // namespace weft
