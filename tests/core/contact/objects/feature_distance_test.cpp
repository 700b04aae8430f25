#include "core/contact/objects/feature_distance.h"

#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include "core/contact/objects/cloth_patches.h"
#include "core/contact/objects/feature_blocks.h"
#include "core/geometry/distance.h"
#include "tests/support/seeded_random.h"

// The vector code of the broad phase against the scalar closest points in double, and the patches
// that it works on.

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

constexpr std::size_t kCloth = 5, kMesh = 19;

using Corners = std::array<Vec3d, 3>;

/// Triangles and segments of every kind: plain, thin, collinear, with equal corners, one point, and
/// parallel to those of the same kind.
Corners any_corners(Random& random, int kind) {
  Corners c{random.vector(1), random.vector(1), random.vector(1)};
  if (kind == 1) c[2] = c[0] + (c[1] - c[0]) * random.uniform(-0.5, 1.5) + random.vector(1e-3);
  if (kind == 2) c[2] = c[0] + (c[1] - c[0]) * random.uniform(-0.5, 1.5);
  if (kind == 3) c[2] = c[1];
  if (kind == 4) c[1] = c[2] = c[0];
  if (kind == 5) c[1] = c[0] + Vec3d(random.uniform(0.1, 1), 0, 0);
  return c;
}

/// Features of a cloth and blocks of a mesh's, and what the distances should be.
template <class Real>
struct Case {
  std::vector<Real> cloth, reach2, boxes;
  std::vector<Aabb<Real>> cloth_boxes;
  std::vector<Index> blocks;  ///< padded
  FeatureBlocks<Real> mesh;
  std::vector<std::vector<double>> distance;

  struct Result {
    std::vector<Index> hits, ends;
    std::vector<Real> hits2, beyond2;
    std::size_t blocks = 0;  ///< looked at

    bool operator==(const Result&) const = default;
  };
  Result run(std::size_t (*measure)(const FeatureTable<Real>&)) const {
    const std::size_t most = kCloth * blocks.size() * kFeatureLanes;
    Result r{std::vector<Index>(most), std::vector<Index>(kCloth), std::vector<Real>(most),
             std::vector<Real>(kCloth)};
    FeatureTable<Real> table;
    table.count = kCloth;
    table.cloth = cloth.data();
    table.cloth_boxes = cloth_boxes.front().lower.data();
    table.reach2 = reach2.data();
    table.stride = blocks.size();
    table.blocks = blocks.data();
    table.boxes = boxes.data();
    table.mesh = mesh.values.data();
    table.hits = r.hits.data();
    table.hits2 = r.hits2.data();
    table.ends = r.ends.data();
    table.beyond2 = r.beyond2.data();
    r.blocks = measure(table);
    r.hits.resize(static_cast<std::size_t>(r.ends.back()));
    r.hits2.resize(r.hits.size());
    return r;
  }
};

enum class Kind { segments, points_from_triangles, triangles_from_points };

template <class Real>
std::array<double, 3> rounded(const Vec3d& v) {
  const Vec3<Real> r = v.cast<Real>();
  return {static_cast<double>(r[0]), static_cast<double>(r[1]), static_cast<double>(r[2])};
}

/// Numbers of a feature: a corner, and the ways to the `others`.
template <class Real>
std::vector<Real> numbers_of(const Corners& c, std::size_t others) {
  std::vector<Real> numbers;
  for (std::size_t k = 0; k <= others; ++k) {
    const Vec3d v = k == 0 ? c[0] : (c[k] - c[0]).eval();
    for (const double x : rounded<Real>(v)) numbers.push_back(static_cast<Real>(x));
  }
  return numbers;
}

/// The corners that those numbers stand for.
template <class Real>
Corners corners_of(const std::vector<Real>& numbers) {
  Corners c;
  for (std::size_t k = 0; 3 * k < numbers.size(); ++k) {
    const Vec3d v(static_cast<double>(numbers[3 * k]), static_cast<double>(numbers[3 * k + 1]),
                  static_cast<double>(numbers[3 * k + 2]));
    c[k] = k == 0 ? v : (c[0] + v).eval();
  }
  return c;
}

double distance_of(Kind kind, const Corners& cloth, const Corners& mesh) {
  if (kind == Kind::segments) {
    const auto c = closest_of_segments<double>(cloth[0], cloth[1], mesh[0], mesh[1]);
    return (c.p - c.q).norm();
  }
  const Corners& t = kind == Kind::points_from_triangles ? mesh : cloth;
  const Vec3d& p = kind == Kind::points_from_triangles ? cloth[0] : mesh[0];
  return (p - closest_on_triangle<double>(p, t[0], t[1], t[2]).point).norm();
}

template <class Real>
Aabb<Real> box_of(const Corners& corners, std::size_t others) {
  Aabb<Real> box;
  for (std::size_t k = 0; k <= others; ++k) box.add(corners[k].cast<Real>());
  return box;
}

/// @param apart  of the blocks of the mesh from each other [m]
template <class Real>
Case<Real> any_case(Random& random, Kind kind, double apart = 0) {
  const std::size_t on_cloth = kind == Kind::segments                ? 1
                               : kind == Kind::points_from_triangles ? 0
                                                                     : 2;
  const std::size_t on_mesh = kind == Kind::segments                ? 1
                              : kind == Kind::points_from_triangles ? 2
                                                                    : 0;
  Case<Real> made;
  std::vector<Corners> cloth, mesh;
  for (std::size_t f = 0; f < kCloth; ++f) {
    const auto numbers = numbers_of<Real>(any_corners(random, random.index(6)), on_cloth);
    made.cloth.insert(made.cloth.end(), numbers.begin(), numbers.end());
    cloth.push_back(corners_of(numbers));
    made.cloth_boxes.push_back(box_of<Real>(cloth.back(), on_cloth));
    const auto reach = static_cast<Real>(random.uniform(0, 1));
    made.reach2.push_back(reach * reach);
  }
  std::vector<std::vector<Real>> numbers;
  std::vector<Index> order;
  for (std::size_t n = 0; n < kMesh; ++n) {
    Corners corners = any_corners(random, random.index(6));
    for (Vec3d& p : corners) p[0] += apart * static_cast<double>(n / kFeatureLanes);
    numbers.push_back(numbers_of<Real>(corners, on_mesh));
    mesh.push_back(corners_of(numbers.back()));
    order.push_back(static_cast<Index>(n));
  }
  made.mesh = in_blocks<Real>(
      order, on_mesh == 2 ? kTriangleNumbers : 3 * (on_mesh + 1),
      [&](Index n) {
        const std::vector<Real>& of = numbers[static_cast<std::size_t>(n)];
        std::vector<Vec3<Real>> vectors;
        for (std::size_t k = 0; k < of.size(); k += 3)
          vectors.emplace_back(of[k], of[k + 1], of[k + 2]);
        return vectors;
      },
      [&](Index n) { return box_of<Real>(mesh[static_cast<std::size_t>(n)], on_mesh); });
  if (on_mesh == 2) prepare_triangles(made.mesh.boxes.size(), made.mesh.values.data());
  made.blocks.assign(kFeatureLanes, 0);
  made.boxes.assign(6 * kFeatureLanes, Real(1e9));
  for (std::size_t b = 0; b < made.mesh.boxes.size(); ++b) {
    made.blocks[b] = static_cast<Index>(b);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Index>(axis);
      made.boxes[axis * kFeatureLanes + b] = made.mesh.boxes[b].lower[k];
      made.boxes[(axis + 3) * kFeatureLanes + b] = made.mesh.boxes[b].upper[k];
    }
  }
  for (const Corners& a : cloth) {
    made.distance.emplace_back();
    for (const Corners& b : mesh) made.distance.back().push_back(distance_of(kind, a, b));
  }
  return made;
}

template <class Real>
void check_against_double(Kind kind, std::size_t (*measure)(const FeatureTable<Real>&),
                          double tolerance) {
  SeededRandom random(7);
  for (int n = 0; n < 2000; ++n) {
    const Case<Real> c = any_case<Real>(random, kind, n % 2 == 0 ? 0 : 2);
    const auto result = c.run(measure);
    std::size_t hit = 0;
    for (std::size_t f = 0; f < kCloth; ++f) {
      INFO("case " << n << " cloth " << f);
      const double reach = std::sqrt(static_cast<double>(c.reach2[f]));
      double nearest_beyond = std::numeric_limits<double>::infinity();
      std::vector<bool> found(kMesh, false);
      for (; hit < static_cast<std::size_t>(result.ends[f]); ++hit) {
        const Index k = c.mesh.feature[static_cast<std::size_t>(result.hits[hit])];
        REQUIRE(k != kNone);
        REQUIRE(!found[static_cast<std::size_t>(k)]);
        found[static_cast<std::size_t>(k)] = true;
        const double distance = c.distance[f][static_cast<std::size_t>(k)];
        REQUIRE(result.hits2[hit] <= c.reach2[f]);
        REQUIRE(std::abs(std::sqrt(static_cast<double>(result.hits2[hit])) - distance) < tolerance);
      }
      for (std::size_t k = 0; k < kMesh; ++k) {
        if (found[k]) continue;
        REQUIRE(c.distance[f][k] > reach - tolerance);
        nearest_beyond = std::min(nearest_beyond, c.distance[f][k]);
      }
      // A bound of all that is beyond reach, and no worse than the distance from its boxes.
      const double beyond = std::sqrt(static_cast<double>(result.beyond2[f]));
      REQUIRE(beyond >= reach);
      REQUIRE(beyond < nearest_beyond + tolerance);
    }
  }
}

template <class Real>
void check_all_kinds(double tolerance) {
  check_against_double<Real>(Kind::segments, measure_segments, tolerance);
  check_against_double<Real>(Kind::points_from_triangles, measure_points_from_triangles, tolerance);
  check_against_double<Real>(Kind::triangles_from_points, measure_triangles_from_points, tolerance);
}

/// Lets the program use these instruction sets alone; 0 for all that there are.
void use_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

TEST_CASE("what is within reach of features is found, degenerate ones too") {
  // A thin triangle may be off by its own thickness over rounding, nearly parallel segments by the
  // root of it.
  SECTION("float, within 1e-3") {
    check_all_kinds<float>(1e-3);
  }
  SECTION("double, within 1e-6") {
    check_all_kinds<double>(1e-6);
  }
}

TEST_CASE("blocks of a mesh beyond reach are not looked at") {
  SeededRandom random(11);
  std::size_t near = 0, far = 0;
  for (int n = 0; n < 100; ++n) {
    near += any_case<float>(random, Kind::segments).run(measure_segments).blocks;
    // Features are 2 m long at most, and reach 1 m: of blocks 10 m apart one is near at most.
    far += any_case<float>(random, Kind::segments, 10).run(measure_segments).blocks;
  }
  CHECK(far <= 100 * kCloth);
  CHECK(near > 200 * kCloth);
}

TEST_CASE("every instruction set finds the same bits") {
  SeededRandom random(3);
  use_targets(0);
  const std::int64_t all = hwy::SupportedTargets();
  for (int n = 0; n < 200; ++n) {
    const Case<float> c = any_case<float>(random, Kind::triangles_from_points, n % 3);
    const Case<float> s = any_case<float>(random, Kind::segments, n % 3);
    use_targets(0);
    const auto best = c.run(measure_triangles_from_points);
    const auto best_segments = s.run(measure_segments);
    for (std::int64_t target = 1; target > 0 && target <= all; target <<= 1) {
      if (!(all & target)) continue;
      use_targets(target);
      INFO(hwy::TargetName(target));
      REQUIRE(c.run(measure_triangles_from_points) == best);
      REQUIRE(s.run(measure_segments) == best_segments);
    }
  }
  use_targets(0);
}

TEST_CASE("every feature of a cloth is in one patch, and patches are small") {
  SeededRandom random(5);
  Vec3Array<float> positions;
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  const Index side = 20;
  for (Index r = 0; r < side; ++r) {
    for (Index c = 0; c < side; ++c) {
      const auto x = static_cast<float>(c), y = static_cast<float>(r);
      positions.emplace_back(x, y, 0.1F * static_cast<float>(random.uniform(-1, 1)));
      const Index i = r * side + c;
      if (c + 1 < side) edges.push_back({i, i + 1});
      if (r + 1 < side) edges.push_back({i, i + side});
      if (c + 1 == side || r + 1 == side) continue;
      edges.push_back({i, i + side + 1});
      triangles.push_back({i, i + 1, i + side + 1});
      triangles.push_back({i, i + side + 1, i + side});
    }
  }
  positions.emplace_back(3.0F, 3.0F, 3.0F);  // a particle of no triangle
  const ClothPatches patches = make_patches(positions, edges, triangles);
  CHECK(
      std::is_permutation(edges.begin(), edges.end(), patches.edges.begin(), patches.edges.end()));
  CHECK(std::is_permutation(triangles.begin(), triangles.end(), patches.triangles.begin(),
                            patches.triangles.end()));
  std::vector<int> seen(positions.size(), 0);
  for (const Index i : patches.particles) ++seen[static_cast<std::size_t>(i)];
  CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  ClothPatch last;
  for (const ClothPatch& patch : patches.list) {
    CHECK(patch.particles.first == last.particles.end());
    CHECK(patch.edges.first == last.edges.end());
    CHECK(patch.triangles.first == last.triangles.end());
    CHECK(patch.triangles.count <= 8);
    last = patch;
  }
  CHECK(last.particles.end() == static_cast<Index>(positions.size()));
  CHECK(last.edges.end() == static_cast<Index>(edges.size()));
  CHECK(last.triangles.end() == static_cast<Index>(triangles.size()));
  // 722 triangles by eights, and the lonely particle.
  CHECK(patches.list.size() <= 92);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto joined_to = [&](Index i, Index j) {
      const auto around = patches.neighbours.of(static_cast<std::size_t>(i));
      return std::count_if(around.begin(), around.end(), [&](const auto& neighbour) {
        return neighbour.particle == j && neighbour.edge == static_cast<Index>(e);
      });
    };
    CHECK(joined_to(edges[e][0], edges[e][1]) == 1);
    CHECK(joined_to(edges[e][1], edges[e][0]) == 1);
  }
}
