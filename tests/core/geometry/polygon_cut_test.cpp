#include "core/geometry/polygon_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "core/geometry/constants.h"

using namespace weft;

namespace {

using Point = std::array<double, 2>;
using Outline = std::vector<Point>;

double doubled(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double doubled_area(const Outline& outline) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    sum += doubled(outline[0], outline[i], outline[i + 1]);
  return sum;
}

bool is_inside(const Outline& outline, const Point& p) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a[1] > p[1]) != (b[1] > p[1]))
      inside = inside != ((doubled(a, b, p) > 0) == (b[1] > a[1]));
  }
  return inside;
}

const std::map<std::string, Outline>& shapes() {
  static const std::map<std::string, Outline> all = {
      {"L", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
      {"plus",
       {{1, 0},
        {2, 0},
        {2, 1},
        {3, 1},
        {3, 2},
        {2, 2},
        {2, 3},
        {1, 3},
        {1, 2},
        {0, 2},
        {0, 1},
        {1, 1}}},
      {"T", {{0, 2}, {1, 2}, {1, 0}, {2, 0}, {2, 2}, {3, 2}, {3, 3}, {0, 3}}},
      {"U", {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}},
      {"arrow", {{0, 0}, {2, 1}, {4, 0}, {2, 4}}},
      {"comb",
       {{0, 0},
        {7, 0},
        {7, 3},
        {6, 3},
        {6, 1},
        {5, 1},
        {5, 3},
        {4, 3},
        {4, 1},
        {3, 1},
        {3, 3},
        {2, 3},
        {2, 1},
        {1, 1},
        {1, 3},
        {0, 3}}},
      {"star",
       {{0, 3},
        {-1, 1},
        {-3, 1},
        {-1.5, -0.5},
        {-2, -3},
        {0, -1.5},
        {2, -3},
        {1.5, -0.5},
        {3, 1},
        {1, 1}}},
      {"hexagon of two squares", {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}}},
      {"square with a corner in a side", {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}},
      {"triangle with a corner in a side", {{0, 0}, {1, 0}, {2, 0}, {0, 2}}},
      {"triangle with rows in its sides",
       {{0, 0},
        {1, 0},
        {2, 0},
        {3, 0},
        {4, 0},
        {3, 1},
        {2, 2},
        {1, 3},
        {0, 4},
        {0, 3},
        {0, 2},
        {0, 1}}},
      {"ring with a cut",
       {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}}},
  };
  return all;
}

/// The outline from another corner on, in either direction.
Outline ordered(Outline outline, std::size_t first, bool backwards) {
  std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end());
  if (backwards) std::reverse(outline.begin(), outline.end());
  return outline;
}

/// In a plane, with coordinates as files have them.
std::vector<Vec3d> laid(const Outline& outline, double scale, const Vec3d& u, const Vec3d& v) {
  std::vector<Vec3d> places;
  for (const Point& p : outline) {
    const Vec3d place = scale * (p[0] * u + p[1] * v);
    places.push_back(place.cast<float>().cast<double>());
  }
  return places;
}

Outline corners_of(const Outline& outline, const Triangle& t) {
  Outline corners;
  for (const Index i : t) corners.push_back(outline.at(static_cast<std::size_t>(i)));
  return corners;
}

double sine_of_smallest_angle(const Outline& t) {
  std::array<double, 3> sides;
  for (std::size_t k = 0; k < 3; ++k)
    sides[k] = std::hypot(t[(k + 1) % 3][0] - t[k][0], t[(k + 1) % 3][1] - t[k][1]);
  std::sort(sides.begin(), sides.end());
  return std::abs(doubled_area(t)) / (sides[1] * sides[2]);
}

/// @returns the sine of the smallest angle of all
double check_cut(const Outline& outline, const PolygonCut& cut) {
  CHECK(cut.limit.empty());
  CHECK(cut.has_area);
  CHECK(cut.triangles.size() == outline.size() - 2);
  const double whole = doubled_area(outline);
  double sum = 0, sharpest = 1;
  std::vector<bool> used(outline.size(), false);
  bool all_inside = true, all_turn_alike = true;
  for (const Triangle& triangle : cut.triangles) {
    const Outline t = corners_of(outline, triangle);
    for (const Index i : triangle) used[static_cast<std::size_t>(i)] = true;
    all_turn_alike = all_turn_alike && doubled_area(t) * whole > 0;
    sum += doubled_area(t);
    sharpest = std::min(sharpest, sine_of_smallest_angle(t));
    for (const auto& w : {Vec3d(0.34, 0.35, 0.31), Vec3d(0.97, 0.02, 0.01), Vec3d(0.01, 0.97, 0.02),
                          Vec3d(0.02, 0.01, 0.97), Vec3d(0.49, 0.49, 0.02), Vec3d(0.02, 0.49, 0.49),
                          Vec3d(0.49, 0.02, 0.49)}) {
      Point p = {0, 0};
      for (std::size_t k = 0; k < 3; ++k) {
        p[0] += w[static_cast<int>(k)] * t[k][0];
        p[1] += w[static_cast<int>(k)] * t[k][1];
      }
      all_inside = all_inside && is_inside(outline, p);
    }
  }
  CHECK(all_inside);
  CHECK(all_turn_alike);
  CHECK(std::all_of(used.begin(), used.end(), [](bool each) { return each; }));
  CHECK(sum == Approx(whole).epsilon(1e-12));
  return sharpest;
}

double cross(const Outline& p, std::size_t i, std::size_t j, std::size_t k) {
  return doubled(p[i], p[j], p[k]);
}

/// Whether no two sides without a common corner touch. Exact for small whole numbers.
bool is_simple(const Outline& p) {
  const std::size_t n = p.size();
  const auto is_on = [&](std::size_t i, std::size_t k) {
    const std::size_t j = (i + 1) % n;
    return cross(p, i, j, k) == 0 && std::min(p[i][0], p[j][0]) <= p[k][0] &&
           p[k][0] <= std::max(p[i][0], p[j][0]) && std::min(p[i][1], p[j][1]) <= p[k][1] &&
           p[k][1] <= std::max(p[i][1], p[j][1]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (k != i && k != (i + 1) % n && is_on(i, k)) return false;
      const std::size_t a = i, b = (i + 1) % n, c = k, d = (k + 1) % n;
      if (cross(p, a, b, c) * cross(p, a, b, d) < 0 && cross(p, c, d, a) * cross(p, c, d, b) < 0)
        return false;
    }
  }
  return true;
}

PolygonCut cut_flat(const Outline& outline) {
  return cut_polygon(laid(outline, 1, Vec3d::UnitX(), Vec3d::UnitY()));
}

}  // namespace

TEST_CASE("triangles of a polygon cover it, in each order, direction, plane and size") {
  const Vec3d tilted = Vec3d(1, 2, 3).normalized(),
              across = tilted.cross(Vec3d::UnitX()).normalized();
  const std::vector<std::array<Vec3d, 2>> planes = {{Vec3d::UnitX(), Vec3d::UnitY()},
                                                    {Vec3d::UnitZ(), Vec3d::UnitX()},
                                                    {Vec3d::UnitZ(), Vec3d::UnitY()},
                                                    {tilted, across}};
  for (const auto& [name, outline] : shapes()) {
    for (std::size_t first = 0; first < outline.size(); ++first) {
      for (const bool backwards : {false, true}) {
        const Outline given = ordered(outline, first, backwards);
        for (const double scale : {0.04, 1.0, 700.0}) {
          for (const auto& [u, v] : planes) {
            INFO(name << " from " << first << (backwards ? " backwards" : "") << ", times " << scale
                      << " along " << u.transpose());
            CHECK(check_cut(given, cut_polygon(laid(given, scale, u, v))) > 0.04);
          }
        }
      }
    }
  }
}

TEST_CASE("polygons on the points of a grid are cut without flat triangles, however they lie") {
  std::mt19937 random(3);
  int cut = 0;
  for (int trial = 0; trial < 40000; ++trial) {
    const std::size_t n = 4 + random() % 6;
    Outline outline;
    for (std::size_t i = 0; i < n; ++i)
      outline.push_back({static_cast<double>(random() % 4), static_cast<double>(random() % 4)});
    if (!is_simple(outline)) continue;
    ++cut;
    INFO("trial " << trial);
    const double tenth = 0.1;
    check_cut(outline, cut_flat(outline));
    const Vec3d u(0.6 * tenth, 0.48 * tenth, 0.64 * tenth),
        v(-0.8 * tenth, 0.36 * tenth, 0.48 * tenth);
    CHECK(check_cut(outline, cut_polygon(laid(outline, 1, u, v))) > 0.01);
  }
  CHECK(cut > 500);
}

TEST_CASE("large random polygons about a point are cut") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> radius(0.05, 1);
  for (const int n : {5, 17, 100, 700}) {
    Outline outline;
    for (int i = 0; i < n; ++i) {
      const double turn = 2 * std::numbers::pi * i / n, r = radius(random);
      outline.push_back(
          {static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn))});
    }
    check_cut(outline, cut_flat(outline));
  }
}

TEST_CASE("a polygon that is not quite plane is cut as seen along its normal") {
  const Outline outline = shapes().at("plus");
  std::vector<Vec3d> places = laid(outline, 1, Vec3d::UnitX(), Vec3d::UnitY());
  for (std::size_t i = 0; i < places.size(); ++i) places[i][2] = i % 2 == 0 ? 0.05 : -0.05;
  check_cut(outline, cut_polygon(places));
}

TEST_CASE("four corners are cut from the concave or flat one, else from the first") {
  const auto first_of = [](const Outline& outline) {
    const PolygonCut cut = cut_flat(outline);
    REQUIRE(cut.triangles.size() == 2);
    CHECK(cut.triangles[0][0] == cut.triangles[1][0]);
    CHECK(cut.triangles[0][2] == cut.triangles[1][1]);
    return cut.triangles[0][0];
  };
  const Outline square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, arrow = shapes().at("arrow"),
                flat = shapes().at("triangle with a corner in a side");
  for (std::size_t k = 0; k < 4; ++k) {
    const auto place = static_cast<Index>((5 - k) % 4);
    CHECK(first_of(ordered(square, k, false)) == 0);
    CHECK(first_of(ordered(arrow, k, false)) == place);
    CHECK(first_of(ordered(flat, k, false)) == place);
  }
}

TEST_CASE("corners in one place count as one") {
  const PolygonCut cut = cut_flat({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}});
  REQUIRE(cut.triangles.size() == 2);
  CHECK(cut.has_area);
  CHECK(cut_flat({{0, 0}, {1, 0}, {1, 1}, {1, 1}}).triangles.size() == 1);
}

TEST_CASE("a polygon without area says so, and its triangles are flat") {
  const Outline row = {{0, 0}, {0.1, 0.23}, {0.3, 0.69}, {0.2, 0.46}, {0.7, 1.61}};
  const PolygonCut cut = cut_flat(row);
  CHECK(!cut.has_area);
  CHECK(cut.limit.empty());
  CHECK(cut.triangles.size() == 3);
  CHECK(!cut_flat({{0, 0}, {1, 0}, {0, 0}, {1, 0}}).has_area);
}

TEST_CASE("polygons whose sides cross, that go round twice or have too many corners are refused") {
  Outline pentagram, twice, many;
  for (int i = 0; i < 5; ++i) {
    const double turn = 4 * std::numbers::pi * i / 5;
    pentagram.push_back({std::cos(turn), std::sin(turn)});
  }
  for (int i = 0; i < 12; ++i)
    twice.push_back({std::cos(std::numbers::pi * i / 3), std::sin(std::numbers::pi * i / 3)});
  for (std::size_t i = 0; i <= kMostPolygonCorners; ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / 5000;
    many.push_back({std::cos(turn), std::sin(turn)});
  }
  const Outline bow = {{0, 0}, {3, 0}, {0, 1}, {1, 2}};
  const Outline even_bow = {{7, 0}, {0, 2}, {2, 0}, {2, 2}};
  const Outline inner_loop = {{0, 0}, {4, 0}, {4, 4}, {2, 0}, {3, -3}, {1, -3}, {2, 0}, {0, 4}};
  const Outline through_a_side = {{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 0}, {1, -1}, {0, 2}};
  for (const Outline& outline :
       {pentagram, twice, many, bow, even_bow, inner_loop, through_a_side}) {
    const PolygonCut cut = cut_flat(outline);
    CHECK(!cut.limit.empty());
    CHECK(cut.triangles.empty());
  }
  CHECK(cut_flat(many).limit == "polygons of at most 4096 corners");
}

TEST_CASE("a spike is refused, because no triangle has its tip") {
  CHECK(!cut_flat({{0, 0}, {2, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}}).limit.empty());
}
