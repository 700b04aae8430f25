#include "core/diagnostics/strain.h"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"

using namespace weft;

namespace {

std::vector<double> sorted_strains(const ClothModel<double>& model, const Vec3Array<double>& x) {
  std::vector<double> all;
  for (std::size_t n = 0; n < model.springs.size(); ++n) {
    if (model.spring_kinds[n] == SpringKind::skip) continue;
    const Spring<double>& s = model.springs[n];
    const double length =
        (x[static_cast<std::size_t>(s.j)] - x[static_cast<std::size_t>(s.i)]).norm();
    all.push_back(std::abs(length / s.rest_length - 1));
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

TEST_CASE("a cloth scaled by a factor has that strain everywhere (1e-12)") {
  const ClothModel<double> model = build_cloth<double>(test::flat_cloth(6, 9));
  std::vector<double> scratch;
  for (const double factor : {0.7, 1.0, 1.25}) {
    Vec3Array<double> x = model.rest_positions;
    for (Vec3d& p : x) p *= factor;
    const StrainStatistics strain = strain_statistics(model, x, scratch);
    CHECK(strain.largest == Approx(std::abs(factor - 1)).margin(1e-12));
    CHECK(strain.p99 == Approx(std::abs(factor - 1)).margin(1e-12));
  }
}

TEST_CASE("largest and p99 strain of a shaken cloth are those of the sorted list (1e-12)") {
  test::SeededRandom random(11);
  for (const int columns : {2, 5, 31}) {
    ClothDef def = test::flat_cloth(columns + 3, columns, 0.1 * (columns - 1), 0.1 * (columns + 2));
    def.skip_stiffness = 5;  // its springs do not count
    const ClothModel<double> model = build_cloth<double>(def);
    const Vec3Array<double> x = test::shaken(model, 0.02, random);
    const std::vector<double> sorted = sorted_strains(model, x);
    std::vector<double> scratch;
    const StrainStatistics strain = strain_statistics(model, x, scratch);
    CHECK(strain.largest == Approx(sorted.back()).margin(1e-12));
    CHECK(strain.p99 == Approx(sorted[(sorted.size() - 1) * 99 / 100]).margin(1e-12));
  }
}

TEST_CASE("one torn spring among many is the largest strain and not the p99") {
  const ClothModel<double> model = build_cloth<double>(test::flat_cloth(20, 20));
  Vec3Array<double> x = model.rest_positions;
  x[0] -= Vec3d(0.5, 0, 0.5);  // three springs of some thousand
  std::vector<double> scratch;
  const StrainStatistics strain = strain_statistics(model, x, scratch);
  CHECK(strain.largest > 5);
  CHECK(strain.p99 < 1e-12);
}
