#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "core/contact/feature_pair.h"
#include "core/contact/guard/cloth_guard.h"
#include "core/contact/guard/pair_separation.h"
#include "core/diagnostics/crossings.h"
#include "tests/support/passing.h"
#include "tests/support/seeded_random.h"

// The theorem on regions: whoever stays in his region passes through nothing.

using namespace weft;
using test::FourPoints;
using test::Random;
using test::Repeatable;
using test::seed_or;
using test::SeededRandom;

namespace {

/// What makes a pair awkward.
enum Trouble {
  kUsual,
  kTiny,
  kParallel,  ///< nearly: edges side by side, a triangle that is flat
  kNeedle,    ///< nearly without area or length
  kNoArea,    ///< nor has an edge length
  kPoint,     ///< a triangle that is a point, and two edges that are
  kFar,       ///< one of the others, far from the origin
};
constexpr int kTroubles = 7;
constexpr std::array<const char*, kTroubles> kTroubleNames = {
    "usual", "tiny", "parallel", "needle", "no area", "point", "far"};

/// How many pairs of each awkwardness were truly tried.
struct Tally {
  std::array<int, kTroubles> tried{};

  void check(int least) const {
    for (std::size_t k = 0; k < kTroubles; ++k) {
      INFO(kTroubleNames[k]);
      CHECK(tried[k] > least);
    }
  }
};

/// Largest distance from the origin at which features of centimetres are tried [m]: there a
/// coordinate is rounded by a thousandth of their size.
template <class Real>
constexpr double kFarthest = sizeof(Real) == 4 ? 200 : 1e11;

/// Rounding of coordinates as large as those of the pair [m].
template <class Real>
double rounding_at(const PairPoints<Real>& x) {
  Real largest = 0;
  for (const Vec3<Real>& p : x) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return static_cast<double>(largest * std::numeric_limits<Real>::epsilon());
}

/// Some way off along any direction, as far as the precision carries; near or far as often.
template <class Real>
Vec3d far_away(Random& random) {
  Vec3d way = random.vector(1);
  way /= way.cwiseAbs().maxCoeff();
  return way * std::pow(10, random.uniform(0, std::log10(kFarthest<Real>)));
}

/// Pairs of all kinds of awkwardness, their sides apart by 10 um to 3 mm and what coordinates are
/// rounded by, or anyhow.
template <class Real>
PairPoints<Real> awkward_pair(PairKind kind, int trouble, Random& random) {
  const bool far = trouble == kFar;
  const Vec3d away = far ? far_away<Real>(random) : Vec3d(Vec3d::Zero());
  if (far) trouble = static_cast<int>(random.index(kFar));
  FourPoints q;
  const double size = trouble == kTiny ? 1e-3 : 0.02;
  for (Vec3d& p : q) p = random.vector(size);
  const std::size_t middle = first_side(kind);
  if (trouble == kParallel) {
    if (kind == PairKind::edge_edge) {
      q[2] = q[0] + random.vector(1e-3);
      q[3] = q[1] + random.vector(1e-3);
    } else {
      for (Vec3d& p : q) p[1] *= 1e-3;
    }
  }
  if (trouble == kNeedle) q[3] = q[2] + random.vector(1e-6);
  if (trouble == kNoArea) q[3] = q[2];
  if (trouble == kPoint) q[3] = q[2];
  if (trouble == kPoint) q[1] = kind == PairKind::vertex_triangle ? q[2] : q[0];
  const Vec3d n = random.vector(1).normalized();
  double low = 1e9, high = -1e9;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k < middle)
      low = std::min(low, n.dot(q[k]));
    else
      high = std::max(high, n.dot(q[k]));
  }
  const double rounded = away.cwiseAbs().maxCoeff() * std::numeric_limits<Real>::epsilon();
  const double gap = std::pow(10, random.uniform(-5, -2.5)) + 8 * rounded;
  if (random.uniform(0, 1) < 0.8) {
    for (std::size_t k = 0; k < middle; ++k) q[k] += n * (high - low + gap);
  }
  PairPoints<Real> x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = (q[k] + away).template cast<Real>();
  return x;
}

/// Relative to a point near by, so that who judges has the room that double gives.
template <class Real>
FourPoints in_double(const PairPoints<Real>& x, const Vec3<Real>& near) {
  FourPoints q;
  for (std::size_t k = 0; k < 4; ++k)
    q[k] = x[k].template cast<double>() - near.template cast<double>();
  return q;
}

template <class Real>
void check_balls(unsigned seed) {
  Random random(seed);
  Tally tally;
  for (int n = 0; n < 30000; ++n) {
    const auto kind = n % 2 == 0 ? PairKind::vertex_triangle : PairKind::edge_edge;
    const int trouble = (n / 2) % kTroubles;
    const PairPoints<Real> x = awkward_pair<Real>(kind, trouble, random);
    const PairSeparation<Real> s = separate_pair(kind, x);
    // Less what is rounded when gaps are measured and corners are put there: 2 roundings of the
    // largest coordinate either side. The guard leaves 64 of them.
    const double slack =
        1e-9 + 2 * static_cast<double>(std::numeric_limits<Real>::epsilon()) + 4 * rounding_at(x);
    const double share = random.uniform(0, 1), gap = static_cast<double>(s.gap) - slack;
    if (!(gap > 1e-6)) continue;
    ++tally.tried[static_cast<std::size_t>(trouble)];
    // Both sides anywhere in balls that share the gap, between them on straight lines.
    PairPoints<Real> y[2];
    for (PairPoints<Real>& end : y) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double radius = gap * (k < first_side(kind) ? share : 1 - share);
        // Straight at the other side, or anywhere on the ball.
        const Vec3d towards = s.normal.template cast<double>() * (k < first_side(kind) ? -1 : 1);
        const Vec3d way = random.uniform(0, 1) < 0.5 ? towards : random.vector(1).normalized();
        end[k] = (x[k].template cast<double>() + way * radius).template cast<Real>();
      }
    }
    const bool vertex = kind == PairKind::vertex_triangle;
    // The axis still has them apart, with or without area; independently, nothing passed.
    INFO(kTroubleNames[static_cast<std::size_t>(trouble)] << " at " << x[0].transpose());
    REQUIRE(gap_along(kind, y[0], s.normal) > 0);
    REQUIRE(gap_along(kind, y[1], s.normal) > 0);
    const FourPoints start = in_double(x, x[0]), one = in_double(y[0], x[0]);
    REQUIRE_FALSE(test::pass_through(vertex, one, in_double(y[1], x[0]), 60));
    REQUIRE_FALSE(test::pass_through(vertex, start, one, 20));
  }
  tally.check(1000);
}

/// Many awkward pairs in one array of positions, four a pair, and where they are a little later.
template <class Real>
struct PairCloud {
  QuadArray<Real> x, end;
  PairColumns<Real> columns;

  PairCloud(PairKind kind, std::size_t count, Random& random) {
    columns.kind = kind;
    for (std::size_t n = 0; n < count; ++n) {
      const auto first = static_cast<Index>(x.size());
      for (const Vec3<Real>& p :
           awkward_pair<Real>(kind, static_cast<int>(n % kTroubles), random)) {
        x.push_back(to_quad(p));
        end.push_back(to_quad<Real>(p + random.vector(0.002).template cast<Real>()));
      }
      columns.add(first, 0, {first, first + 1, first + 2, first + 3});
    }
    separate_pairs(x, end, columns);
  }
  PairPoints<Real> points(const QuadArray<Real>& from, std::size_t n) const {
    return {to_vector(from[4 * n]), to_vector(from[4 * n + 1]), to_vector(from[4 * n + 2]),
            to_vector(from[4 * n + 3])};
  }
};

template <class Real>
void check_separated_together(PairKind kind, unsigned seed) {
  Random random(seed);
  const PairCloud<Real> cloud(kind, 6003, random);  // not whole vectors
  const double rounding = 64 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  Tally compared;
  for (std::size_t n = 0; n < cloud.columns.size(); ++n) {
    const PairPoints<Real> x = cloud.points(cloud.x, n), end = cloud.points(cloud.end, n);
    const PairSeparation<Real> together = cloud.columns.separation(n, cloud.x);
    const PairSeparation<Real> alone = separate_pair(kind, x);
    if (!(cloud.columns.gap[n] > static_cast<Real>(kCloseGap))) {
      REQUIRE(together.gap == alone.gap);
      continue;
    }
    ++compared.tried[n % kTroubles];
    const auto apart = [&](const PairPoints<Real>& at) {
      return static_cast<double>(gap_along(kind, at, together.normal));
    };
    REQUIRE(static_cast<double>(together.normal.norm()) == Approx(1).epsilon(rounding));
    REQUIRE(std::abs(apart(x) - static_cast<double>(together.gap)) <= rounding * 0.1);
    REQUIRE(std::abs(apart(end) - static_cast<double>(cloud.columns.end_gap[n])) <= rounding * 0.1);
    // The best axis is unique but where sides are parallel, so the gaps are the same.
    REQUIRE(static_cast<double>(together.gap) ==
            Approx(static_cast<double>(alone.gap)).epsilon(0.01).margin(1e-5));
    Vec3<Real> way = Vec3<Real>::Zero();
    for (std::size_t k = 1; k < 4; ++k) way += (x[k] - x[0]) * together.weight[k];
    REQUIRE(static_cast<double>((way - together.normal * way.norm()).norm()) <= 1e-5);
    REQUIRE(static_cast<double>(way.norm()) ==
            Approx(static_cast<double>(together.gap)).margin(1e-5));
  }
  compared.check(100);
}

}  // namespace

TEST_CASE("pairs that are separated together lie apart as those separated one by one") {
  const unsigned seed = seed_or(7);
  const Repeatable repeatable(seed);
  for (const PairKind kind : {PairKind::vertex_triangle, PairKind::edge_edge}) {
    check_separated_together<double>(kind, seed);
    check_separated_together<float>(kind, seed + 1);
  }
}

TEST_CASE("wherever the corners of a pair are in balls that share its gap, it has not crossed") {
  const unsigned seed = seed_or(1);
  const Repeatable repeatable(seed);
  check_balls<double>(seed);
  check_balls<float>(seed + 1);
}

TEST_CASE("a certified gap is never more than the distance, and as much where nothing is thin") {
  SeededRandom random(3);
  Tally far_apart;
  int lost = 0;
  for (int n = 0; n < 20000; ++n) {
    const auto kind = n % 2 == 0 ? PairKind::vertex_triangle : PairKind::edge_edge;
    const int trouble = (n / 2) % kTroubles;
    PairPoints<double> x = awkward_pair<double>(kind, trouble, random);
    const PairSeparation<double> s = separate_pair(kind, x);
    for (std::size_t k = 4; k-- > 0;) x[k] -= x[0];
    // The distance, by samples: never below the true one.
    double nearest = 1e9;
    for (int i = 0; i <= 24; ++i) {
      for (int j = 0; j <= 24; ++j) {
        const double u = i / 24.0, v = j / 24.0;
        if (kind == PairKind::vertex_triangle) {
          const Vec3d p = x[1] + (x[2] - x[1]) * u + (x[3] - x[2]) * (u * v);
          nearest = std::min(nearest, (x[0] - p).norm());
        } else {
          nearest = std::min(nearest, (x[0] + (x[1] - x[0]) * u - x[2] - (x[3] - x[2]) * v).norm());
        }
      }
    }
    REQUIRE(s.gap <= nearest + 1e-12);
    if (nearest < 2e-3) continue;
    ++far_apart.tried[static_cast<std::size_t>(trouble)];
    lost += s.gap < 0.9 * nearest - 1e-3;
  }
  far_apart.check(200);
  CHECK(lost == 0);
}

namespace {

struct CcdCase {
  PairKind kind;
  const char* name;
  PairPoints<double> from, to;
};

/// Cases with exact answers, all hits; dyadic coordinates, exact in double.
std::vector<CcdCase> hits() {
  constexpr auto kFace = PairKind::vertex_triangle;
  constexpr auto kEdges = PairKind::edge_edge;
  const Vec3d o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), up(0, 0, 1), p(0.25, 0.25, 0);
  return {{kFace, "centre hit", {p + up, o, x, y}, {p - up, o, x, y}},
          {kFace, "stops exactly on face", {p + up, o, x, y}, {p, o, x, y}},
          {kFace, "hits vertex 0", {up, o, x, y}, {-up, o, x, y}},
          {kFace, "coplanar slide into triangle", {Vec3d(2, 0.25, 0), o, x, y}, {p, o, x, y}},
          {kFace,
           "face moves, vertex still",
           {p, o + up, x + up, y + up},
           {p, o - 3 * up, x - 3 * up, y - 3 * up}},
          {kEdges, "crossing edges", {-x + up, x + up, -y, y}, {-x - up, x - up, -y, y}},
          {kEdges,
           "zero length edge through edge",
           {y / 2 + up, y / 2 + up, -y, y},
           {y / 2 - up, y / 2 - up, -y, y}}};
}

}  // namespace

TEST_CASE("where features truly meet, some corner leaves its ball whatever the shares are") {
  for (const CcdCase& hit : hits()) {
    INFO(hit.name);
    const PairSeparation<double> s = separate_pair(hit.kind, hit.from);
    REQUIRE(s.gap > 0);
    double side[2] = {0, 0};
    for (std::size_t k = 0; k < 4; ++k) {
      double& most = side[k < first_side(hit.kind) ? 0 : 1];
      most = std::max(most, (hit.to[k] - hit.from[k]).norm());
    }
    CHECK(side[0] + side[1] >= s.gap);                       // no shares hold both
    CHECK_FALSE(gap_along(hit.kind, hit.to, s.normal) > 0);  // nor does the axis certify the step
  }
}
