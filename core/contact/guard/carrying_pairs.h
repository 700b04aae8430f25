#pragma once

#include <array>

#include "core/contact/guard/constants.h"
#include "core/contact/guard/guarded_cloths.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/nearer_neighbour.h"
#include "core/contact/guard/pair_separation.h"
#include "core/math/quad.h"
#include "core/types.h"

// Which of the pairs that lie side by side carries what presses there.

namespace weft {

/// Whether two edges carry each other: they are nearest between their ends and, if they are nearly
/// parallel, nearer than the surfaces beside them. Such edges that pass each other are nearest
/// aslant, where edges that cross are so across both.
/// @param x       positions [m]
/// @param pushes  says whether they push each other already
template <class Real>
bool edges_carry(const GuardedCloths<Real>& cloths, const QuadArray<Real>& x,
                 const std::array<Index, 4>& particles, const PairSeparation<Real>& s,
                 auto&& pushes) {
  if (!s.inside) return false;
  const Quad<Real> a = x[at_index(particles[1])] - x[at_index(particles[0])],
                   b = x[at_index(particles[3])] - x[at_index(particles[2])];
  const Real ab = dot(a, b), both2 = dot(a, a) * dot(b, b);
  if (ab * ab < both2 * (1 - Real(kParallel * kParallel))) return true;
  const Real most = static_cast<Real>(pushes() ? kStillNearest : kLeadsNearer);
  const Quad<Real> back = to_quad(s.normal), there = back * Real(-1);
  for (std::size_t k = 0; k < 4; ++k) {
    if (has_nearer_neighbour(cloths, x, particles[k], particles, k < 2 ? there : back, most))
      return false;
  }
  return true;
}

/// Whether a pair carries, and not what is nearer beside it, past which it slides.
template <class Real>
bool carries(const GuardedCloths<Real>& cloths, const QuadArray<Real>& x,
             const GuardedPair<Real>& pair, const PairSeparation<Real>& s, auto&& pushes) {
  if (pair.kind == PairKind::edge_edge) return edges_carry(cloths, x, pair.particle, s, pushes);
  return s.inside || own_nearest(cloths, x, pair.b, pair.particle, s, pushes());
}

}  // namespace weft
