#pragma once

#include <algorithm>
#include <array>

#include "core/contact/guard/guarded_cloths.h"
#include "core/math/quad.h"
#include "core/types.h"

// Whether the surface beside a feature comes nearer to what the feature meets.

namespace weft {

/// Whether a neighbour of a pair's particle comes nearer to the pair's other side than that does.
/// @param x          positions [m]
/// @param particles  of the pair, which do not count as neighbours
/// @param towards    the other side, unit
/// @param most       cosine between the ways there and to a neighbour that does not count [1]
template <class Real>
bool has_nearer_neighbour(const GuardedCloths<Real>& cloths, const QuadArray<Real>& x,
                          Index particle, const std::array<Index, 4>& particles,
                          const Quad<Real>& towards, Real most) {
  const auto around = cloths.neighbours.of(at_index(particle));
  return std::any_of(around.begin(), around.end(), [&](const auto& neighbour) {
    const Index i = neighbour.particle;
    if (std::find(particles.begin(), particles.end(), i) != particles.end()) return false;
    const Quad<Real> way = x[at_index(i)] - x[at_index(particle)];
    const Real nearer = dot(towards, way);
    return nearer > 0 && nearer * nearer > dot(way, way) * most * most;
  });
}

}  // namespace weft
