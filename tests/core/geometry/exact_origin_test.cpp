#include "core/geometry/exact_origin.h"

#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/seeded_random.h"

using namespace weft;

TEMPLATE_TEST_CASE("from their exact origin places are seen without rounding, and in finer steps",
                   "", float, double) {
  test::SeededRandom random(3);
  for (int n = 0; n < 200; ++n) {
    const double far = random.uniform(-30, 30), size = random.uniform(0.01, 2);
    std::vector<Vec3<TestType>> places;
    for (int k = 0; k < 50; ++k) {
      const Vec3d place = Vec3d(far, far / 7, -far) + size * random.vector(1);
      places.push_back(place.cast<TestType>());
    }
    const Vec3<TestType> origin = exact_origin<TestType>(places);
    for (const Vec3<TestType>& place : places) {
      const Vec3<TestType> seen = place - origin;
      REQUIRE(origin + seen == place);
      const auto wide = [](const Vec3<TestType>& v) {
        return v.template cast<long double>().eval();
      };
      REQUIRE(wide(seen) == wide(place) - wide(origin));
      for (int k = 0; k < 3; ++k) REQUIRE(std::abs(seen[k]) <= std::abs(place[k]));
    }
    // Cloth away from the origin is seen from amidst.
    if (std::abs(far) > 7 * 3 * size) REQUIRE((places[0] - origin).norm() < 4 * size);
  }
}

TEST_CASE("places on both sides of zero, or without end, have zero as their exact origin") {
  const float huge = std::numeric_limits<float>::infinity();
  const std::vector<Vec3f> places = {{-1, 2, 3}, {1, 2, huge}};
  const Vec3f origin = exact_origin<float>(places);
  CHECK(origin[0] == 0);
  CHECK(origin[1] == 2);
  CHECK(origin[2] == 0);
}
