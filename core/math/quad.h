#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

#include "core/math/aligned_vector.h"
#include "core/types.h"

// Four-number vectors in registers.

namespace weft {

/// Four numbers processed together, in registers of any instruction set with the same bits. A
/// spatial vector has 0 as its fourth.
template <class Real>
struct Quad {
  using Lanes [[gnu::vector_size(4 * sizeof(Real))]] = Real;
  Lanes lanes = {0, 0, 0, 0};

  Real operator[](int k) const { return lanes[k]; }
  Quad& operator+=(const Quad& o) {
    lanes += o.lanes;
    return *this;
  }
  Quad& operator-=(const Quad& o) {
    lanes -= o.lanes;
    return *this;
  }
  friend Quad operator+(Quad a, const Quad& b) { return a += b; }
  friend Quad operator-(Quad a, const Quad& b) { return a -= b; }
  friend Quad operator*(const Quad& a, Real s) { return {a.lanes * s}; }
};

/// x a + y b + z c of spatial vectors, added in that order.
template <class Real>
Real dot(const Quad<Real>& a, const Quad<Real>& b) {
  const Quad<Real> product{a.lanes * b.lanes};
  return product[0] + product[1] + product[2];
}

template <class Real>
Real length(const Quad<Real>& a) {
  return std::sqrt(dot(a, a));
}

template <class Real>
Quad<Real> to_quad(const Vec3<Real>& v) {
  Quad<Real> q;
  q.lanes[0] = v[0];
  q.lanes[1] = v[1];
  q.lanes[2] = v[2];
  return q;
}

template <class Real>
Vec3<Real> to_vector(const Quad<Real>& q) {
  return {q[0], q[1], q[2]};
}

template <class Real>
using QuadArray = AlignedVector<Quad<Real>>;

/// Converts vectors to quads. All but the last are read as four numbers at once, which costs half.
/// @param to  of the same length
template <class Real>
void to_quads(std::span<const Vec3<Real>> from, Quad<Real>* to) {
  if (from.empty()) return;
  assert(to != nullptr);
  const std::size_t last = from.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    std::memcpy(&to[i].lanes, static_cast<const void*>(&from[i]), sizeof to[i].lanes);
    to[i].lanes[3] = 0;
  }
  to[last] = to_quad(from[last]);
}

/// Converts quads to vectors. Each write spills one number into the next vector, which the next
/// write repairs.
/// @param to  of the same length
template <class Real>
void to_vectors(std::span<const Quad<Real>> from, Vec3<Real>* to) {
  if (from.empty()) return;
  assert(to != nullptr);
  const std::size_t last = from.size() - 1;
  for (std::size_t i = 0; i < last; ++i)
    std::memcpy(static_cast<void*>(&to[i]), &from[i].lanes, sizeof from[i].lanes);
  to[last] = to_vector(from[last]);
}

}  // namespace weft
