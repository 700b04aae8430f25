// Sums the curvatures of a flat mesh's triangles into one quadratic form.

#include "core/cloth/mesh_bending.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/cloth/constants.h"
#include "core/cloth/edge_slope.h"
#include "core/cloth/membrane.h"

namespace weft {
namespace {

using Slopes = std::vector<std::vector<ParticleWeight>>;  // by edge

/// A particle's share in the curvature of a triangle along both threads and between them [1/m^2].
struct CurvatureWeight {
  Index particle = kNone;
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
};

void add_weight(Index particle, const Eigen::Vector3d& weight, std::vector<CurvatureWeight>& list) {
  for (CurvatureWeight& one : list) {
    if (one.particle != particle) continue;
    one.weight += weight;
    return;
  }
  list.push_back({particle, weight});
}

/// A triangle laid flat with its threads along the axes.
struct FlatTriangle {
  std::array<Eigen::Vector2d, 3> corner;
  double area = 0;

  template <class Real>
  FlatTriangle(const ClothModel<Real>& model, const Triangle& t) {
    std::array<Vec3d, 3> x;
    RestCorners material;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(t[k]);
      x[k] = model.rest_positions[i].template cast<double>();
      material[k] = {static_cast<double>(model.material[i][0]),
                     static_cast<double>(model.material[i][1])};
    }
    const RestCorners flat = laid_flat(x, material);
    for (std::size_t k = 0; k < 3; ++k) corner[k] = {flat[k][0], flat[k][1]};
    const Eigen::Vector2d a = corner[1] - corner[0], b = corner[2] - corner[0];
    area = 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]);
    assert(area > 0);
  }

  /// The way out across the edge opposite to a corner, as long as that edge.
  Eigen::Vector2d outward(std::size_t k) const {
    const Eigen::Vector2d edge = corner[(k + 2) % 3] - corner[(k + 1) % 3];
    const Eigen::Vector2d across(edge[1], -edge[0]);
    return across.dot(corner[k] - corner[(k + 1) % 3]) > 0 ? (-across).eval() : across;
  }
};

/// The curvature of a triangle: over its area, the sum over its edges of by how much the slope
/// outwards is steeper there than in the triangle, times the edge's length and direction.
/// @param slopes  of all edges
std::vector<CurvatureWeight> curvature(const Triangle& t, std::size_t index,
                                       const FlatTriangle& flat, const EdgeSlopes& mesh,
                                       const Slopes& slopes) {
  std::vector<CurvatureWeight> list;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto e = static_cast<std::size_t>(mesh.edges_of(index)[k]);
    const Eigen::Vector2d out = flat.outward(k);
    const double length = out.norm();
    // `out` twice is twice the direction and twice the length, of which one is the edge's.
    const Eigen::Vector3d direction =
        Eigen::Vector3d(out[0] * out[0], out[1] * out[1], out[0] * out[1]) / (length * flat.area);
    const bool is_first = mesh.edges()[e].triangle[0] == static_cast<Index>(index);
    for (const ParticleWeight& one : slopes[e])
      add_weight(one.particle, direction * (is_first ? -one.weight : one.weight), list);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      // The gradient of a corner's linear function is that to the opposite edge, inwards.
      const double inside = -flat.outward(corner).dot(out) / (2 * flat.area * length);
      add_weight(t[corner], -direction * inside, list);
    }
  }
  return list;
}

/// The upper half of the form's matrix, by rows, and its diagonal.
class BendingMatrix {
 public:
  explicit BendingMatrix(std::size_t particles) : rows_(particles), diagonal_(particles, 0) {}

  /// Adds what a triangle resists with.
  /// @param rigidity  of its curvatures, times its area [N m^3]
  void add(const std::vector<CurvatureWeight>& curvature, const Eigen::Vector3d& rigidity) {
    for (std::size_t a = 0; a < curvature.size(); ++a) {
      const Eigen::Vector3d pull = rigidity.cwiseProduct(curvature[a].weight);
      diagonal_[at(curvature[a])] += pull.dot(curvature[a].weight);
      for (std::size_t b = 0; b < a; ++b) {
        const auto [i, j] = std::minmax(curvature[a].particle, curvature[b].particle);
        add_weight(j, -pull.dot(curvature[b].weight), rows_[static_cast<std::size_t>(i)]);
      }
    }
  }

  std::vector<BendingLink> links() {
    std::vector<BendingLink> links;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      std::sort(rows_[i].begin(), rows_[i].end(),
                [](const auto& a, const auto& b) { return a.particle < b.particle; });
      for (const auto& [j, weight] : rows_[i]) {
        const double scale = std::sqrt(diagonal_[i] * diagonal_[static_cast<std::size_t>(j)]);
        if (std::abs(weight) > kLeastLink * scale)
          links.push_back({static_cast<Index>(i), j, weight});
      }
    }
    return links;
  }

 private:
  static std::size_t at(const CurvatureWeight& one) {
    return static_cast<std::size_t>(one.particle);
  }

  std::vector<std::vector<ParticleWeight>> rows_;
  std::vector<double> diagonal_;
};

}  // namespace

template <class Real>
std::vector<BendingLink> mesh_bending_links(const FabricDef& fabric,
                                            const ClothModel<Real>& model) {
  assert(model.parts.size() == 1);
  Vec3Array<double> x;
  for (const Vec3<Real>& p : model.rest_positions) x.push_back(p.template cast<double>());
  const EdgeSlopes mesh(x, model.triangles);
  Slopes slopes;
  for (const EdgeSides& edge : mesh.edges()) slopes.push_back(mesh.across(edge));
  BendingMatrix matrix(x.size());
  const Eigen::Vector3d rigidity(fabric.bending_warp, fabric.bending_weft,
                                 fabric.bending_warp + fabric.bending_weft);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const FlatTriangle flat(model, model.triangles[t]);
    matrix.add(curvature(model.triangles[t], t, flat, mesh, slopes), rigidity * flat.area);
  }
  return matrix.links();
}

template std::vector<BendingLink> mesh_bending_links(const FabricDef&, const ClothModel<float>&);
template std::vector<BendingLink> mesh_bending_links(const FabricDef&, const ClothModel<double>&);

}  // namespace weft
