// Loads features of cloths, and lists those of meshes near them.

#include "core/contact/objects/pair_features.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <initializer_list>

#include "core/instantiate.h"

namespace weft {
namespace {

template <class Real>
void add_feature(Index feature, Real reach, Real error, const Aabb<Real>& box,
                 std::initializer_list<Vec3<Real>> vectors, PairFeatures<Real>& into) {
  assert(feature >= 0 && !(reach < 0));
  into.number.push_back(feature);
  into.reach2.push_back(reach * reach);
  into.rounding.push_back(error);
  into.boxes.push_back(box);
  into.around.add(box.grown(reach));
  for (const Vec3<Real>& v : vectors) into.values.insert(into.values.end(), {v[0], v[1], v[2]});
}

template <class Real>
void clear_features(PairFeatures<Real>& features) {
  features.number.clear();
  features.values.clear();
  features.reach2.clear();
  features.rounding.clear();
  features.boxes.clear();
  features.around = {};
}

}  // namespace

template <class Real>
void load_particles(const PairPass<Real>& pass, const NearPatch& patch, PairFeatures<Real>& into) {
  clear_features(into);
  const Clearance<Real>& c = pass.clearance;
  for (Index k = patch.particles.first; k < patch.particles.end(); ++k) {
    const Index i = pass.near.particles[at_index(k)];
    const auto p = at_index(i);
    const Real reach = pass.cloths.thickness + c.skin[p];
    if (c.distance[p] > reach) {
      pass.free.particle[p] = c.distance[p] - pass.cloths.thickness;
      continue;
    }
    Aabb<Real> box;
    box.add(pass.x[p]);
    add_feature(i, reach, pass.mesh.rounding, box, {pass.x[p]}, into);
  }
}

template <class Real>
void load_edges(const PairPass<Real>& pass, const NearPatch& patch, PairFeatures<Real>& into) {
  clear_features(into);
  const Clearance<Real>& c = pass.clearance;
  for (Index k = patch.edges.first; k < patch.edges.end(); ++k) {
    const Index e = pass.near.edges[at_index(k)];
    const Edge& ends = pass.cloths.patches.edges[at_index(e)];
    const auto i = at_index(ends[0]), j = at_index(ends[1]);
    const Real reach = pass.cloths.thickness + std::max(c.skin[i], c.skin[j]);
    const Vec3<Real> along = pass.x[j] - pass.x[i];
    // No point of the edge is nearer than this, by the clearances of its ends.
    const Real length = along.norm(), clear = (c.distance[i] + c.distance[j] - length) / 2;
    if (clear > reach) {
      pass.free.edge[at_index(e)] = clear - pass.cloths.thickness;
      continue;
    }
    Aabb<Real> box;
    box.add(pass.x[i]);
    box.add(pass.x[j]);
    add_feature(e, reach, rounding_of_segments(length, pass.mesh.longest_edge), box,
                {pass.x[i], along}, into);
  }
}

template <class Real>
void load_triangles(const PairPass<Real>& pass, const NearPatch& patch, PairFeatures<Real>& into) {
  clear_features(into);
  const Clearance<Real>& clearance = pass.clearance;
  const Vec3Array<Real>& x = pass.x;
  const auto largest = [](const std::vector<Real>& of, std::size_t a, std::size_t b,
                          std::size_t c) {
    return std::max({of[a], of[b], of[c]});
  };
  for (Index k = patch.triangles.first; k < patch.triangles.end(); ++k) {
    const Index t = pass.near.triangles[at_index(k)];
    const Triangle& corners = pass.cloths.patches.triangles[at_index(t)];
    const auto a = at_index(corners[0]), b = at_index(corners[1]), c = at_index(corners[2]);
    const Real reach = pass.cloths.thickness + largest(clearance.skin, a, b, c);
    const std::vector<Real>& distance = clearance.distance;
    const Real clear =
        std::min({distance[a], distance[b], distance[c]}) - largest(clearance.span, a, b, c);
    if (clear > reach) {
      pass.free.triangle[at_index(t)] = clear - pass.cloths.thickness;
      continue;
    }
    Aabb<Real> box;
    for (const std::size_t corner : {a, b, c}) box.add(x[corner]);
    const Vec3<Real> ab = x[b] - x[a], ac = x[c] - x[a];
    const Real longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    const Real error = rounding_of_triangle(std::sqrt(longest2), ab.cross(ac).norm());
    add_feature(t, reach, error, box, {x[a], ab, ac}, into);
  }
}

template <class Real>
void list_blocks(const MeshShape<Real>& mesh, Neighbourhood<Real>& about) {
  // Padding is far away, yet near enough for its square to be a number.
  constexpr Real kPadding = Real(1e9);
  const auto list = [&](const FeatureBlocks<Real>& of, NearBlocks<Real>& into) {
    into.list.clear();
    of.tree.for_each_overlap(about.box, [&](Index b) { into.list.push_back(b); });
    const std::size_t count = into.list.size();
    const std::size_t stride = (count + kFeatureLanes - 1) / kFeatureLanes * kFeatureLanes;
    into.list.resize(stride, 0);
    into.boxes.assign(6 * stride, kPadding);
    for (std::size_t n = 0; n < count; ++n) {
      const Aabb<Real>& box = of.boxes[at_index(into.list[n])];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        into.boxes[axis * stride + n] = box.lower[static_cast<Index>(axis)];
        into.boxes[(axis + 3) * stride + n] = box.upper[static_cast<Index>(axis)];
      }
    }
  };
  list(mesh.triangle_blocks, about.triangles);
  list(mesh.ridge_blocks, about.ridges);
  list(mesh.corner_blocks, about.corners);
}

WEFT_INSTANTIATE_FUNCTIONS(load_particles, load_edges, load_triangles, list_blocks)

}  // namespace weft
