#include "core/math/quad.h"

#include <array>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <catch2/catch.hpp>

using namespace weft;

namespace {

/// Numbers whose bits a calculation might change.
template <class Real>
std::vector<Vec3<Real>> odd_vectors(std::size_t count) {
  using Limits = std::numeric_limits<Real>;
  const std::array<Real, 7> odd = {Real(-0.0),          Limits::denorm_min(), Limits::quiet_NaN(),
                                   -Limits::infinity(), Limits::max(),        Real(1) / 3,
                                   Limits::min()};
  std::vector<Vec3<Real>> vectors(count);
  std::size_t next = 0;
  for (Vec3<Real>& v : vectors) {
    for (int c = 0; c < 3; ++c) v[c] = odd[next++ % odd.size()];
  }
  return vectors;
}

template <class Element>
bool same_bits(const Element& a, const Element& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEMPLATE_TEST_CASE("vectors are the same bits as quads and back, and nothing beside is touched", "",
                   float, double) {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 8u, 97u}) {
    CAPTURE(count);
    const std::vector<Vec3<TestType>> all = odd_vectors<TestType>(count + 1);
    const std::span<const Vec3<TestType>> from = std::span(all).first(count);
    const Quad<TestType> mark{{7, 7, 7, 7}};
    QuadArray<TestType> quads(count + 1, mark);
    to_quads(from, quads.data());
    for (std::size_t i = 0; i < count; ++i) {
      CHECK(same_bits(to_vector(quads[i]), all[i]));
      CHECK(same_bits(quads[i][3], TestType(0)));
    }
    CHECK(same_bits(quads[count], mark));
    std::vector<Vec3<TestType>> back(count + 1, Vec3<TestType>(5, 5, 5));
    to_vectors(std::span<const Quad<TestType>>(quads).first(count), back.data());
    for (std::size_t i = 0; i < count; ++i) CHECK(same_bits(back[i], all[i]));
    CHECK(back[count] == Vec3<TestType>(5, 5, 5));
  }
}
