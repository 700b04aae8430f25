#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "core/forces/hinge.h"
#include "core/geometry/hinge_angle.h"
#include "core/world/world.h"

namespace weft::test {

/// How a cloth is folded, from its triangles alone.
struct Folds {
  double mean = 0;   ///< of the angles between neighbouring triangles, all positive [rad]
  double twist = 0;  ///< of the same angles with their signs: to which side it curls [rad]
  double sharp = 0;  ///< part of them beyond 60 degrees
};

/// The ends of every inner edge, and the opposite corners of its two triangles.
inline std::vector<std::array<std::size_t, 4>> inner_edges(const std::vector<Triangle>& triangles) {
  std::map<std::pair<Index, Index>, Index> opposite;
  std::vector<std::array<std::size_t, 4>> list;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      const auto other = opposite.find({b, a});
      if (other == opposite.end())
        opposite[{a, b}] = c;
      else
        list.push_back({static_cast<std::size_t>(b), static_cast<std::size_t>(a),
                        static_cast<std::size_t>(other->second), static_cast<std::size_t>(c)});
    }
  }
  return list;
}

template <class Real>
Folds measure_folds(const World<Real>& world) {
  Folds folds;
  const auto edges = inner_edges(world.model().triangles);
  for (const auto& e : edges) {
    const auto at = [&](std::size_t k) {
      return Vec3d(world.state().x[e[k]].template cast<double>());
    };
    const double theta = hinge_angle<double>(at(0), at(1), at(2), at(3)).theta;
    folds.mean += std::abs(theta);
    folds.twist += theta;
    folds.sharp += std::abs(theta) > 1.0471975 ? 1 : 0;
  }
  const auto count = static_cast<double>(edges.size());
  return {folds.mean / count, folds.twist / count, folds.sharp / count};
}

/// Ticks that must not diverge.
template <class Real>
void step(World<Real>& world, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) {
    if (world.step().divergence) throw std::runtime_error(describe(*world.report().divergence));
  }
}

}  // namespace weft::test
