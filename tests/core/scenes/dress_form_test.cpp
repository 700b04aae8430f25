#include "core/scenes/dress_form.h"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

using namespace weft;

namespace {

double smallest_angle(const TriangleMesh& mesh, const Triangle& t) {
  double least = 180;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = [&](std::size_t n) {
      return mesh.positions[static_cast<std::size_t>(t[n % 3])];
    };
    const Vec3d u = at(k + 1) - at(k), v = at(k + 2) - at(k);
    least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / 3.14159265358979);
  }
  return least;
}

/// Extent of the vertices with y in a range.
Vec3d extent(const TriangleMesh& mesh, double low, double high) {
  Vec3d lower = Vec3d::Constant(1e9), upper = Vec3d::Constant(-1e9);
  for (const Vec3d& p : mesh.positions) {
    if (p[1] < low || p[1] > high) continue;
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  return upper - lower;
}

}  // namespace

TEST_CASE(
    "the dressmaker's form is one closed surface of 1,418 triangles without holes or handles") {
  const TriangleMesh form = make_dress_form();
  CHECK(form.triangles.size() == 1418);
  CHECK_NOTHROW(validate(form, "form."));
  CHECK(is_closed(form));
  CHECK(enclosed_volume(form) > 0.03);
  // Euler: vertices - edges + faces = 2 for a sphere; each vertex is used.
  CHECK(form.positions.size() - edges_of(form).size() + form.triangles.size() == 2);
  std::vector<char> used(form.positions.size(), 0);
  for (const Triangle& t : form.triangles)
    for (const Index i : t) used[static_cast<std::size_t>(i)] = 1;
  CHECK(std::count(used.begin(), used.end(), 0) == 0);
}

TEST_CASE("the dressmaker's form has the same bits on every processor: whole micrometres") {
  for (const Vec3d& p : make_dress_form().positions) {
    for (const double c : p) CHECK(c == std::round(c * 1e6) / 1e6);
  }
}

TEST_CASE("the dressmaker's form has no thin triangle") {
  const TriangleMesh form = make_dress_form();
  double least = 180;
  int thin = 0;
  for (const Triangle& t : form.triangles) {
    const double angle = smallest_angle(form, t);
    least = std::min(least, angle);
    thin += angle < 12;
  }
  CHECK(least > 7);
  CHECK(thin < 120);  // those of the pole
}

TEST_CASE("the dressmaker's form is open to the eye as one: foot, pole, hips, waist, bust, neck") {
  const TriangleMesh form = make_dress_form();
  double low = 1e9, high = -1e9;
  for (const Vec3d& p : form.positions) {
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
  }
  CHECK(low == 0);
  CHECK(high == Approx(1.5).margin(0.1));
  const double foot = extent(form, 0, 0.05)[0], pole = extent(form, 0.1, 0.65)[0];
  const double hips = extent(form, 0.8, 0.9)[0], waist = extent(form, 1.02, 1.07)[0];
  const double shoulders = extent(form, 1.3, 1.4)[0], neck = extent(form, 1.48, 1.515)[0];
  const double bust = extent(form, 1.19, 1.24)[2], waist_depth = extent(form, 1.02, 1.07)[2];
  CHECK(pole < foot / 4);
  CHECK(waist < 0.8 * hips);
  CHECK(waist < 0.8 * shoulders);
  CHECK(neck < waist / 2);
  CHECK(bust > 1.2 * waist_depth);
}

TEST_CASE("every face of the dressmaker's form looks away from its axis, so it cannot cut itself") {
  const TriangleMesh form = make_dress_form();
  for (std::size_t t = 0; t < form.triangles.size(); ++t) {
    const Vec3d n = unit_normal(form, static_cast<Index>(t));
    Vec3d middle = Vec3d::Zero();
    for (const Index i : form.triangles[t])
      middle += form.positions[static_cast<std::size_t>(i)] / 3;
    middle[1] = 0;
    INFO("triangle " << t);
    CHECK(n.dot(middle) > -1e-9);
  }
}
