#include <cstdlib>
#include <set>

#include <catch2/catch.hpp>

#include "core/contact/feature_pair.h"
#include "core/contact/guard/patch_boxes.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

using namespace weft;
using namespace weft::test;

namespace {

using Pairs = std::set<std::array<Index, 3>>;  // kind, feature, feature

bool share(const std::array<Index, 4>& p, std::size_t middle) {
  for (std::size_t i = 0; i < middle; ++i)
    for (std::size_t k = middle; k < 4; ++k)
      if (p[i] == p[k]) return true;
  return false;
}

/// Whether the features come so near that balls around their corners' paths touch: by sampled
/// times, so never when they do not.
bool come_near(PairKind kind, const std::array<Index, 4>& p, const PredictedMotion<float>& m,
               int times = 8) {
  for (int t = 0; t <= times; ++t) {
    PairPoints<double> x;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(p[k]);
      const Vec3d start = to_vector(m.start[i]).cast<double>();
      const Vec3d end = to_vector(m.end[i]).cast<double>();
      x[k] = start + (end - start) * (t / static_cast<double>(times));
    }
    if (separate_pair(kind, x).gap < 2 * static_cast<double>(m.radius)) return true;
  }
  return false;
}

/// Kinds and features of all pairs in the given patches that come near.
template <class Visit>
void visit_features(const ClothModel<float>& model, const PatchTree<float>::Patch& a,
                    const PatchTree<float>::Patch& b, bool same, Visit&& visit) {
  const auto vertices = [&](const auto& p, const auto& q) {
    for (const Index v : p.vertices) {
      for (const Index t : q.triangles) {
        const Triangle& c = model.triangles[static_cast<std::size_t>(t)];
        visit(PairKind::vertex_triangle, v, t, std::array<Index, 4>{v, c[0], c[1], c[2]});
      }
    }
  };
  vertices(a, b);
  if (!same) vertices(b, a);
  for (const Index e : a.edges) {
    for (const Index f : b.edges) {
      if (same && f <= e) continue;
      const Edge &p = model.edges[static_cast<std::size_t>(std::min(e, f))],
                 &q = model.edges[static_cast<std::size_t>(std::max(e, f))];
      visit(PairKind::edge_edge, std::min(e, f), std::max(e, f),
            std::array<Index, 4>{p[0], p[1], q[0], q[1]});
    }
  }
}

struct Found {
  Pairs pairs;
  std::size_t visited = 0;          ///< pairs of patches
  std::size_t spread_together = 0;  ///< and those that were not, as they are stretched out together
};

Found find_pairs(const ClothModel<float>& model, PatchTree<float>& tree,
                 const PredictedMotion<float>& motion, bool cull, int times = 8) {
  Found found;
  tree.refit(motion, cull);
  tree.for_each_near_pair([&](Index p, Index q) {
    if (cull && tree.are_spread(p, q, motion)) {
      ++found.spread_together;
      return;
    }
    ++found.visited;
    visit_features(model, tree.patch(p), tree.patch(q), p == q,
                   [&](PairKind kind, Index a, Index b, const std::array<Index, 4>& particle) {
                     if (share(particle, first_side(kind))) return;
                     if (come_near(kind, particle, motion, times))
                       found.pairs.insert({static_cast<Index>(kind), a, b});
                   });
  });
  return found;
}

/// All pairs of features, one by one.
Pairs all_pairs(const ClothModel<float>& model, const PredictedMotion<float>& motion) {
  PatchTree<float>::Patch all;
  for (Index i = 0; i < model.particle_count(); ++i) all.vertices.push_back(i);
  for (std::size_t e = 0; e < model.edges.size(); ++e) all.edges.push_back(static_cast<Index>(e));
  for (std::size_t t = 0; t < model.triangles.size(); ++t)
    all.triangles.push_back(static_cast<Index>(t));
  Pairs pairs;
  visit_features(model, all, all, true,
                 [&](PairKind kind, Index a, Index b, const std::array<Index, 4>& particle) {
                   if (share(particle, first_side(kind))) return;
                   if (come_near(kind, particle, motion))
                     pairs.insert({static_cast<Index>(kind), a, b});
                 });
  return pairs;
}

/// A cloth rolled up with a pitch, waved, or both; the roll's layers lie near each other.
PredictedMotion<float> wrap(const ClothModel<float>& model, double radius, double pitch,
                            double wave, Random& random) {
  PredictedMotion<float> motion;
  for (const Vec3f& p : model.rest_positions) {
    const double s = static_cast<double>(p[0]), z = static_cast<double>(p[2]);
    const double angle = radius > 0 ? s / radius : 0;
    const double r = radius + pitch * angle;
    Vec3d x = radius > 0 ? Vec3d(r * std::sin(angle), r * std::cos(angle), z) : Vec3d(s, 0, z);
    x[1] += wave * std::sin(30 * z);
    motion.start.push_back(to_quad<float>(x.cast<float>()));
    const Vec3d moved = x + Vec3d(0.01, -0.02, 0) + random.vector(0.003);
    motion.end.push_back(to_quad<float>(moved.cast<float>()));
  }
  motion.radius = 0.005f;
  return motion;
}

/// The second cloth, flat, is folded back at a distance from its first row or column, with layers
/// so near that they touch.
PredictedMotion<float> folded(const ClothModel<float>& model, double line, bool across,
                              Random& random) {
  PredictedMotion<float> motion;
  const IndexRange& second = model.parts[1].particles;
  for (Index i = 0; i < model.particle_count(); ++i) {
    Vec3d x = model.rest_positions[static_cast<std::size_t>(i)].cast<double>();
    double& along = across ? x[0] : x[2];
    if (second.contains(i) && along > line + 1e-4) {
      along = line + 0.03 - (along - line - 0.03);
      x[1] += 0.004;
    }
    motion.start.push_back(to_quad<float>(x.cast<float>()));
    const Vec3d moved = x + Vec3d(0.01, -0.02, 0) + random.vector(0.001);
    motion.end.push_back(to_quad<float>(moved.cast<float>()));
  }
  motion.radius = 0.005f;
  return motion;
}

}  // namespace

TEST_CASE("patches with and without the cull find every pair that a search of all pairs finds") {
  SeededRandom random(5);
  for (const auto& [rows, columns] : {std::pair{13, 12}, {9, 17}, {2, 40}}) {
    const ClothModel<float> model =
        build_cloth<float>(flat_cloth(rows, columns, 0.03 * (columns - 1), 0.03 * (rows - 1)));
    PatchTree<float> tree(model);
    for (const double radius : {0.0, 0.05, 0.2}) {
      for (const double wave : {0.0, 0.02}) {
        INFO(rows << " x " << columns << ", radius " << radius << ", wave " << wave);
        const PredictedMotion<float> motion = wrap(model, radius, 0.0015, wave, random);
        const Pairs expected = all_pairs(model, motion);
        const Found plain = find_pairs(model, tree, motion, false);
        const Found culled = find_pairs(model, tree, motion, true);
        CHECK(plain.pairs == expected);
        CHECK(culled.pairs == expected);
        CHECK(culled.visited <= plain.visited);
      }
    }
  }
}

TEST_CASE("patches beside a sharp fold are culled without any pair across it") {
  SeededRandom random(6);
  std::size_t culled = 0;
  for (const auto& [rows, columns] :
       {std::pair{2, 40}, {40, 2}, {6, 12}, {12, 6}, {3, 3}, {7, 10}}) {
    ClothDef mesh = triangle_sheet(Cut::irregular, 0.15, 0.15, 0.03);
    mesh.origin = Vec3d(5, 0, 0);
    const ClothModel<float> model = build_cloths<float>(
        {mesh, flat_cloth(rows, columns, 0.03 * (columns - 1), 0.03 * (rows - 1))});
    PatchTree<float> tree(model);
    for (int across = 0; across < 2; ++across) {
      for (int line = 0; line + 1 < (across == 0 ? rows : columns); ++line) {
        INFO(rows << " x " << columns << ", folded behind " << (across == 0 ? "row " : "column ")
                  << line);
        const PredictedMotion<float> motion = folded(model, 0.03 * line, across != 0, random);
        const Found found = find_pairs(model, tree, motion, true);
        CHECK(found.pairs == all_pairs(model, motion));
        culled += found.spread_together;
      }
    }
  }
  CHECK(culled > 1000);
}

TEST_CASE("after some particles changed their way, old pairs and changed patches give all pairs") {
  SeededRandom random(9);
  std::size_t visited = 0, all = 0;
  for (const auto& [rows, columns] : {std::pair{21, 20}, {9, 25}}) {
    const ClothModel<float> model =
        build_cloth<float>(flat_cloth(rows, columns, 0.03 * (columns - 1), 0.03 * (rows - 1)));
    for (const double radius : {0.0, 0.05, 0.2}) {
      PatchTree<float> tree(model);
      PredictedMotion<float> motion = wrap(model, radius, 0.0015, 0, random);
      Pairs known = find_pairs(model, tree, motion, true, 32).pairs;
      for (int time = 0; time < 3; ++time) {
        INFO(rows << " x " << columns << ", radius " << radius << ", time " << time);
        // A third of the time goes by, and one region flies off, over its neighbours.
        std::vector<char> changed(model.mass.size(), 0);
        std::vector<Index> particles;
        const auto middle = static_cast<std::size_t>(random.uniform(0, 1) * (columns * rows - 1));
        for (std::size_t i = 0; i < changed.size(); ++i) {
          motion.start[i] += (motion.end[i] - motion.start[i]) * (1.0f / 3);
          if ((model.rest_positions[i] - model.rest_positions[middle]).norm() > 0.07f) continue;
          changed[i] = 1;
          particles.push_back(static_cast<Index>(i));
          const Vec3f way = Vec3f(0.05f, 0.01f, 0.02f) * static_cast<float>(time - 1) +
                            random.vector(0.01).cast<float>();
          motion.end[i] = motion.start[i] + to_quad(way);
        }
        const auto is_changed = [&](const std::array<Index, 4>& particle) {
          return std::any_of(particle.begin(), particle.end(),
                             [&](Index i) { return changed[static_cast<std::size_t>(i)] != 0; });
        };
        tree.refit_changed(motion, particles, changed);
        tree.for_each_near_pair([&](Index, Index) { ++all; });
        Pairs found;
        tree.for_each_changed_pair([&](Index p, Index q) {
          if (tree.are_spread(p, q, motion)) return;
          ++visited;
          visit_features(model, tree.patch(p), tree.patch(q), p == q,
                         [&](PairKind kind, Index a, Index b, const auto& particle) {
                           if (share(particle, first_side(kind))) return;
                           if (!is_changed(particle)) return;
                           if (come_near(kind, particle, motion, 32))
                             found.insert({static_cast<Index>(kind), a, b});
                         });
        });
        // Nearer, so that the times looked at before cannot have missed them.
        PredictedMotion<float> nearer = motion;
        nearer.radius *= 0.8f;
        for (const auto& pair : all_pairs(model, nearer))
          REQUIRE((found.count(pair) || known.count(pair)));
        known.insert(found.begin(), found.end());
      }
    }
  }
  CHECK(visited < all);
}

TEST_CASE("a flat or gently waved cloth is culled as one, and no patch of it is visited") {
  SeededRandom random(7);
  const ClothModel<float> model = build_cloth<float>(flat_cloth(33, 33, 1, 1));
  PatchTree<float> tree(model);
  std::size_t visited = 0;
  tree.refit(wrap(model, 0, 0, 0.003, random), true);
  tree.for_each_near_pair([&](Index, Index) { ++visited; });
  CHECK(visited == 0);
  tree.refit(wrap(model, 0, 0, 0.003, random), false);
  tree.for_each_near_pair([&](Index, Index) { ++visited; });
  CHECK(visited > 256);
}

TEST_CASE("a cloth that was rolled up for long is culled as one again soon after it is flat") {
  SeededRandom random(8);
  const ClothModel<float> model = build_cloth<float>(flat_cloth(33, 33, 1, 1));
  PatchTree<float> tree(model);
  const auto visited = [&](double radius) {
    std::size_t count = 0;
    tree.refit(wrap(model, radius, 0, 0.003, random), true);
    tree.for_each_near_pair([&](Index, Index) { ++count; });
    return count;
  };
  for (int k = 0; k < 100; ++k) REQUIRE(visited(0.05) > 0);
  for (int k = 0; k < 7; ++k) visited(0);
  CHECK(visited(0) == 0);
  // After a single roll one search passes.
  REQUIRE(visited(0.05) > 0);
  visited(0);
  CHECK(visited(0) == 0);
  for (int k = 0; k < 100; ++k) REQUIRE(visited(0.05) > 0);
  tree.forget();
  CHECK(visited(0) == 0);
}

TEST_CASE("a sheet that is spread out at both ends of its motion but not between is not culled") {
  // Straight paths of half a turn in its plane lead every particle through the centre.
  const ClothModel<float> model = build_cloth<float>(flat_cloth(9, 9, 1, 1));
  Vec3f centre = Vec3f::Zero();
  for (const Vec3f& p : model.rest_positions) centre += p / 81;
  PredictedMotion<float> motion;
  for (const Vec3f& p : model.rest_positions) {
    motion.start.push_back(to_quad(p));
    motion.end.push_back(to_quad<float>(2 * centre - p));
  }
  motion.radius = 0.005f;
  PatchTree<float> tree(model);
  const bool found_all = find_pairs(model, tree, motion, true).pairs == all_pairs(model, motion);
  CHECK(found_all);
}

TEST_CASE("of two patches exactly the features that share a particle are left out") {
  const ClothModel<float> model = build_cloth<float>(flat_cloth(9, 12));
  const PatchTree<float> tree(model);
  std::size_t left_out = 0;
  const auto check = [&](PairKind kind, const std::array<Index, 4>& particle, std::uint32_t bits,
                         std::size_t n) {
    const bool kept = (bits >> n & 1) != 0;
    left_out += kept ? 0 : 1;
    REQUIRE(kept == !share(particle, first_side(kind)));
  };
  const auto vertices = [&](const auto& p, const auto& q, const PatchOverlaps::Bits& bits) {
    for (std::size_t k = 0; k < p.vertices.size(); ++k) {
      for (std::size_t n = 0; n < q.triangles.size(); ++n) {
        const Triangle& c = model.triangles[static_cast<std::size_t>(q.triangles[n])];
        check(PairKind::vertex_triangle, {p.vertices[k], c[0], c[1], c[2]}, bits[k], n);
      }
    }
  };
  const auto count = static_cast<Index>(tree.patch_count());
  for (Index a = 0; a < count; ++a) {
    for (Index b = a; b < count; ++b) {
      PatchOverlaps all;
      for (PatchOverlaps::Bits* bits :
           {&all.first_vertices, &all.second_vertices, &all.first_edges})
        bits->fill(~0u);
      const auto &p = tree.patch(a), &q = tree.patch(b);
      leave_out_incident<float>(p, q, all);
      vertices(p, q, all.first_vertices);
      vertices(q, p, all.second_vertices);
      for (std::size_t k = 0; k < p.edges.size(); ++k) {
        for (std::size_t n = 0; n < q.edges.size(); ++n) {
          const Edge &e = model.edges[static_cast<std::size_t>(p.edges[k])],
                     &f = model.edges[static_cast<std::size_t>(q.edges[n])];
          check(PairKind::edge_edge, {e[0], e[1], f[0], f[1]}, all.first_edges[k], n);
        }
      }
    }
  }
  CHECK(left_out > 1000);
}

TEST_CASE("every particle, edge and triangle belongs to one patch") {
  const ClothModel<float> model = build_cloth<float>(flat_cloth(11, 14));
  const PatchTree<float> tree(model);
  std::vector<int> vertices(model.mass.size()), edges(model.edges.size()),
      triangles(model.triangles.size());
  for (std::size_t p = 0; p < tree.patch_count(); ++p) {
    const auto& patch = tree.patch(static_cast<Index>(p));
    for (const Index i : patch.vertices) ++vertices[static_cast<std::size_t>(i)];
    for (const Index i : patch.edges) ++edges[static_cast<std::size_t>(i)];
    for (const Index i : patch.triangles) ++triangles[static_cast<std::size_t>(i)];
  }
  const auto all_one = [](const std::vector<int>& counts) {
    return std::all_of(counts.begin(), counts.end(), [](int n) { return n == 1; });
  };
  CHECK(all_one(vertices));
  CHECK(all_one(edges));
  CHECK(all_one(triangles));
}
