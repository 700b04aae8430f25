#include "core/geometry/ray_cast.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/scenes/dress_form.h"
#include "tests/support/seeded_random.h"

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

template <class Real>
struct Soup {
  Vec3Array<Real> positions;
  std::vector<Triangle> triangles;
  Bvh<Real> tree;

  void add(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto first = static_cast<Index>(positions.size());
    for (const Vec3d& p : {a, b, c}) positions.push_back(p.cast<Real>());
    triangles.push_back({first, first + 1, first + 2});
  }
  void build() {
    std::vector<Aabb<Real>> boxes;
    triangle_boxes<Real>(positions, triangles, boxes);
    tree.build(boxes);
  }
  Vec3<Real> corner(Index t, std::size_t k) const {
    return positions[static_cast<std::size_t>(triangles[static_cast<std::size_t>(t)][k])];
  }
  std::optional<RayHit<Real>> cast(const Vec3d& o, const Vec3d& d) const {
    return cast_ray<Real>(o.cast<Real>(), d.cast<Real>(), tree, positions, triangles);
  }
  /// First hit by trying every triangle, without the tree.
  std::optional<RayHit<Real>> brute(const Vec3d& o, const Vec3d& d) const {
    std::optional<RayHit<Real>> best;
    for (Index t = 0; t < static_cast<Index>(triangles.size()); ++t) {
      auto hit =
          cast_ray<Real>(o.cast<Real>(), d.cast<Real>(), corner(t, 0), corner(t, 1), corner(t, 2));
      if (!hit || (best && hit->distance >= best->distance)) continue;
      hit->triangle = t;
      best = hit;
    }
    return best;
  }
};

/// Triangles of every kind: plain, slivers, without area, doubled, far from the origin.
template <class Real>
Soup<Real> soup_of_kind(int kind, int count, Random& random) {
  Soup<Real> soup;
  const Vec3d offset = kind == 4 ? Vec3d(1e3, 1e3, -1e3) : Vec3d::Zero().eval();
  for (int n = 0; n < count; ++n) {
    const Vec3d a = offset + random.vector(1), b = a + random.vector(0.4);
    Vec3d c = a + random.vector(0.4);
    if (kind == 1) c = a + (b - a) * random.uniform(-1, 2) + random.vector(1e-3);
    if (kind == 2 && n % 2) c = n % 4 == 1 ? b : (a + (b - a) * random.uniform(-1, 2)).eval();
    soup.add(a, b, c);
    if (kind == 3) soup.add(a, b, c);
  }
  soup.build();
  return soup;
}

/// Möller and Trumbore's test in long double, as an independent oracle. Returns the parameter of
/// the hit, or -1, and in `margin` how far the hit is from the border (barycentric).
long double oracle(const Vec3d& o, const Vec3d& d, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                   long double& margin) {
  using V = Eigen::Matrix<long double, 3, 1>;
  const V e1 = (b - a).cast<long double>(), e2 = (c - a).cast<long double>();
  const V dd = d.cast<long double>(), p = dd.cross(e2), s = (o - a).cast<long double>();
  const long double det = e1.dot(p);
  margin = -1;
  if (std::abs(det) < 1e-18L) return -1;
  const long double u = s.dot(p) / det, v = dd.dot(s.cross(e1)) / det,
                    t = e2.dot(s.cross(e1)) / det;
  margin = std::min({u, v, 1 - u - v});
  return margin >= 0 && t >= 0 ? t : -1;
}

template <class Real>
void check_hit(const Soup<Real>& soup, const Vec3d& o, const Vec3d& d, const RayHit<Real>& hit,
               double tolerance) {
  Vec3d blend = Vec3d::Zero();
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto w = static_cast<double>(hit.barycentric[k]);
    REQUIRE(w >= 0);
    sum += w;
    blend += w * soup.corner(hit.triangle, k).template cast<double>();
  }
  REQUIRE(std::abs(sum - 1) < 1e-6);
  REQUIRE((o + d * static_cast<double>(hit.distance) - blend).norm() < tolerance);
}

template <class Real>
void check_soups(double tolerance) {
  SeededRandom random(11);
  for (int kind = 0; kind < 5; ++kind) {
    const Soup<Real> soup = soup_of_kind<Real>(kind, 150, random);
    const Vec3d offset = kind == 4 ? Vec3d(1e3, 1e3, -1e3) : Vec3d::Zero().eval();
    const double allowed = kind == 4 ? tolerance * 2000 : tolerance;
    int hits = 0;
    for (int n = 0; n < 1000; ++n) {
      const Vec3d o = offset + random.vector(2);
      Vec3d d = offset + random.vector(1) - o;
      if (n % 7 == 0) d = Vec3d::Unit(n % 3) * (n % 2 ? 1 : -1);  // along an axis
      // Aimed at corners and along edges, where float rounds the ray itself off them.
      const auto t = static_cast<Index>(n % static_cast<int>(soup.triangles.size()));
      if (n % 5 == 0) d = soup.corner(t, 0).template cast<double>() - o;
      if (n % 11 == 0) d = (soup.corner(t, 1) - soup.corner(t, 0)).template cast<double>();
      const auto hit = soup.cast(o, d), brute = soup.brute(o, d);
      INFO("kind " << kind << " n " << n);
      REQUIRE(hit.has_value() == brute.has_value());
      if (!hit) continue;
      ++hits;
      REQUIRE(hit->distance == brute->distance);
      REQUIRE(hit->triangle == brute->triangle);
      check_hit(soup, o, d, *hit, allowed);
    }
    CHECK(hits > 20);
  }
}

}  // namespace

TEST_CASE("the hierarchy finds the hit that brute force finds, bit for bit") {
  SECTION("double") {
    check_soups<double>(1e-9);
  }
  SECTION("float") {
    check_soups<float>(1e-4);
  }
}

TEST_CASE("hits agree with an independent test in long double") {
  SeededRandom random(12);
  const Soup<double> soup = soup_of_kind<double>(0, 100, random);
  for (int n = 0; n < 3000; ++n) {
    const Vec3d o = random.vector(2), d = random.vector(1) - o;
    long double nearest = -1;
    bool doubtful = false;
    for (Index t = 0; t < 100; ++t) {
      long double margin;
      const long double at =
          oracle(o, d, soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2), margin);
      doubtful = doubtful || std::abs(margin) < 1e-9L;
      if (at >= 0 && (nearest < 0 || at < nearest)) nearest = at;
    }
    if (doubtful) continue;
    const auto hit = soup.cast(o, d);
    INFO("n " << n);
    REQUIRE(hit.has_value() == (nearest >= 0));
    if (hit) REQUIRE(hit->distance == Approx(static_cast<double>(nearest)).epsilon(1e-9));
  }
}

TEST_CASE("no ray from inside a closed surface escapes, aimed at corners and edges too") {
  const TriangleMesh mesh = make_dress_form();
  Soup<double> soup;
  soup.positions = mesh.positions;
  soup.triangles = mesh.triangles;
  soup.build();
  const Vec3d inside(0.001, 1.1, 0.002);
  for (const Vec3d& p : mesh.positions) REQUIRE(soup.cast(inside, p - inside));
  for (const MeshEdge& e : edges_of(mesh)) {
    for (const double t : {0.25, 0.5, 0.7}) {
      const Vec3d p = mesh.positions[static_cast<std::size_t>(e.a)] * (1 - t) +
                      mesh.positions[static_cast<std::size_t>(e.b)] * t;
      REQUIRE(soup.cast(inside, p - inside));
    }
  }
  SeededRandom random(13);
  for (int n = 0; n < 5000; ++n) REQUIRE(soup.cast(inside, random.vector(1)));
}

TEST_CASE("of equally near triangles the smallest index is hit") {
  Soup<float> soup;
  for (int n = 0; n < 9; ++n) soup.add(Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0));
  soup.build();
  const auto hit = soup.cast(Vec3d(0.2, 0.2, 1), Vec3d(0, 0, -1));
  REQUIRE(hit);
  CHECK(hit->triangle == 0);
  CHECK(hit->distance == 1.0f);
}

TEST_CASE("triangles are hit from both sides, and not behind the origin") {
  const Vec3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  CHECK(cast_ray<double>(Vec3d(0.2, 0.2, 1), Vec3d(0, 0, -1), a, b, c));
  CHECK(cast_ray<double>(Vec3d(0.2, 0.2, -1), Vec3d(0, 0, 1), a, b, c));
  CHECK_FALSE(cast_ray<double>(Vec3d(0.2, 0.2, 1), Vec3d(0, 0, 1), a, b, c));
}

TEST_CASE(
    "a ray in the plane of a triangle, one without direction, one that is not finite: no hit") {
  const Vec3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  CHECK_FALSE(cast_ray<double>(Vec3d(-1, 0.2, 0), Vec3d(1, 0, 0), a, b, c));
  CHECK_FALSE(cast_ray<double>(Vec3d(-1, 0, 0), Vec3d(1, 0, 0), a, b, c));  // along the edge
  CHECK_FALSE(cast_ray<double>(Vec3d(0.2, 0.2, 1), Vec3d::Zero(), a, b, c));
  const double nan = std::nan("");
  CHECK_FALSE(cast_ray<double>(Vec3d(0.2, nan, 1), Vec3d(0, 0, -1), a, b, c));
  CHECK_FALSE(cast_ray<double>(Vec3d(0.2, 0.2, 1), Vec3d(nan, 0, -1), a, b, c));
}

TEST_CASE("no triangles: no hit") {
  Soup<double> soup;
  soup.build();
  CHECK_FALSE(soup.cast(Vec3d(0, 0, 0), Vec3d(1, 0, 0)));
}
