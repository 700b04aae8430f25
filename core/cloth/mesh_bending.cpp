// Sums the curvatures of a mesh's triangles into one quadratic form.

#include "core/cloth/mesh_bending.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/cloth/constants.h"
#include "core/cloth/corner_places.h"
#include "core/cloth/edge_slope.h"
#include "core/cloth/held_strip.h"
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
  double free = 1;  ///< part of it that no strip holds

  /// @param flat      its corners [m]
  /// @param material  their (u, v) [m]
  FlatTriangle(const RestCorners& flat, const RestCorners& material,
               const std::vector<HeldStrip>& strips)
      : free(strips.empty() ? 1 : free_part(strips, material)) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] = {flat[k][0], flat[k][1]};
    const Eigen::Vector2d a = corner[1] - corner[0], b = corner[2] - corner[0];
    area = 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]);
    assert(area > 0);
  }

  /// Outward normal of the edge opposite to a corner, as long as that edge.
  Eigen::Vector2d outward(std::size_t k) const {
    const Eigen::Vector2d edge = corner[(k + 2) % 3] - corner[(k + 1) % 3];
    const Eigen::Vector2d across(edge[1], -edge[0]);
    return across.dot(corner[k] - corner[(k + 1) % 3]) > 0 ? (-across).eval() : across;
  }
};

/// (u, v) of a particle [m].
template <class Real>
std::array<double, 2> place_of(const ClothModel<Real>& model, Index i) {
  const auto& place = model.material[static_cast<std::size_t>(i)];
  return {static_cast<double>(place[0]), static_cast<double>(place[1])};
}

/// One cloth of a model on its own: particles are counted from its first.
struct PartMesh {
  Vec3Array<double> x;  // at rest [m]
  std::vector<Triangle> triangles;
  std::vector<FlatTriangle> flat;
  std::vector<std::vector<double>> beyond;  // by strip, of each particle [m]

  template <class Real>
  PartMesh(const ClothModel<Real>& model, const ClothPart<Real>& part) {
    for (Index i = part.particles.first; i < part.particles.end(); ++i)
      x.push_back(model.rest_positions[static_cast<std::size_t>(i)].template cast<double>());
    for (const HeldStrip& strip : part.held_strips) {
      beyond.emplace_back();
      for (Index i = part.particles.first; i < part.particles.end(); ++i)
        beyond.back().push_back(distance_beyond(strip, place_of(model, i)));
    }
    for (Index n = part.triangles.first; n < part.triangles.end(); ++n) {
      Triangle t = model.triangles[static_cast<std::size_t>(n)];
      std::array<Vec3d, 3> corners;
      const RestCorners material = corner_places(model, n);
      for (std::size_t k = 0; k < 3; ++k) {
        t[k] -= part.particles.first;
        corners[k] = x[static_cast<std::size_t>(t[k])];
      }
      triangles.push_back(t);
      flat.emplace_back(part.rests_by_triangle ? material : laid_flat(corners, material), material,
                        part.held_strips);
    }
  }

  FlatShapes shapes() const {
    FlatShapes shapes{triangles, {}};
    for (const FlatTriangle& one : flat) shapes.corners.push_back(one.corner);
    return shapes;
  }
};

/// The slope across an edge: that of a held triangle if one of the two is held.
/// @param free    part of each triangle that no strip holds
/// @param beyond  distance of each particle beyond each strip's border [m]
std::vector<ParticleWeight> slope_at(std::size_t number, const std::vector<double>& free,
                                     const std::vector<std::vector<double>>& beyond,
                                     const EdgeSlopes& mesh) {
  const EdgeSides& edge = mesh.edges()[number];
  for (std::size_t side = 0; side < 2; ++side) {
    const Index t = edge.triangle[side];
    if (t != kNone && free[static_cast<std::size_t>(t)] == 0) return mesh.inside(edge, side);
  }
  for (const std::vector<double>& distances : beyond) {
    if (mesh.meets_held(edge, distances)) return mesh.across_clamped(edge, distances);
  }
  return mesh.across(number);
}

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
    const std::size_t side = mesh.edges()[e].triangle[0] == static_cast<Index>(index) ? 0 : 1;
    const double outwards = mesh.goes_into(e, side) ? -1 : 1;
    for (const ParticleWeight& one : slopes[e])
      add_weight(one.particle, direction * (outwards * one.weight), list);
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

  /// Adds the bending stiffness of a triangle.
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
        const double scale = std::min(diagonal_[i], diagonal_[static_cast<std::size_t>(j)]);
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

template <class Real>
void append(std::size_t triangle, const std::vector<CurvatureWeight>& curvature,
            const Eigen::Vector3d& stiffness, TriangleCurvatures<Real>& list) {
  if (list.begin.empty()) list.begin.push_back(0);
  list.triangles.push_back(static_cast<Index>(triangle));
  for (const CurvatureWeight& one : curvature) {
    list.particles.push_back(one.particle);
    list.weights.push_back(one.weight.cast<Real>());
  }
  list.begin.push_back(list.particles.size());
  list.stiffness.push_back(stiffness.cast<Real>());
}

/// Subtracts from a triangle's curvatures their tangential part at rest.
/// @returns their part along its normal [1/m]
Eigen::Vector3d lift_off(const Triangle& t, const Vec3Array<double>& x,
                         std::vector<CurvatureWeight>& curvature) {
  const auto at = [&](Index i) -> const Vec3d& { return x[static_cast<std::size_t>(i)]; };
  Eigen::Matrix3d values = Eigen::Matrix3d::Zero();  // a column for each curvature
  for (const CurvatureWeight& one : curvature)
    values += (at(one.particle) - at(t[0])) * one.weight.transpose();
  Eigen::Matrix<double, 3, 2> edges;
  edges << at(t[1]) - at(t[0]), at(t[2]) - at(t[0]);
  const Vec3d normal = edges.col(0).cross(edges.col(1)).normalized();
  const Eigen::Matrix<double, 2, 3> along =
      (edges.transpose() * edges).inverse() * edges.transpose() * values;
  add_weight(t[0], along.colwise().sum().transpose(), curvature);
  add_weight(t[1], -along.row(0).transpose(), curvature);
  add_weight(t[2], -along.row(1).transpose(), curvature);
  return values.transpose() * normal;
}

/// @param rest       of the curvatures, along the normal [1/m]
/// @param stiffness  of each [N m^3]
template <class Real>
void append(const Triangle& t, const std::vector<CurvatureWeight>& curvature,
            const Eigen::Vector3d& rest, const Eigen::Vector3d& stiffness, double area,
            RestCurves<Real>& curves) {
  if (curves.begin.empty()) curves.begin.push_back(0);
  curves.triangles.push_back(t);
  const Eigen::Vector3d moment = stiffness.cwiseProduct(rest);
  for (const CurvatureWeight& one : curvature) {
    curves.particles.push_back(one.particle);
    curves.pulls.push_back(static_cast<Real>(moment.dot(one.weight)));
  }
  curves.begin.push_back(curves.particles.size());
  curves.smallest_cross.push_back(static_cast<Real>(2 * kCrumpledArea * area));
  curves.energy += 0.5 * moment.dot(rest);
}

}  // namespace

template <class Real>
void bend_by_links(const ClothModel<Real>& model, ClothPart<Real>& part) {
  const PartMesh mesh(model, part);
  const bool unfolds = part.curved_at_rest || part.rests_by_triangle;
  const FlatShapes shapes = unfolds ? mesh.shapes() : FlatShapes();
  const EdgeSlopes edges(mesh.x, mesh.triangles, unfolds ? &shapes : nullptr);
  std::vector<double> free;
  for (const FlatTriangle& flat : mesh.flat) free.push_back(flat.free);
  Slopes slopes;
  for (std::size_t e = 0; e < edges.edges().size(); ++e)
    slopes.push_back(slope_at(e, free, mesh.beyond, edges));
  BendingMatrix matrix(mesh.x.size());
  const FabricDef& fabric = part.fabric;
  const Eigen::Vector3d rigidity(fabric.bending_warp, fabric.bending_weft,
                                 fabric.bending_warp + fabric.bending_weft);
  part.curvatures = {};
  part.rest_curves = {};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const FlatTriangle& flat = mesh.flat[t];
    if (flat.free == 0) continue;
    const double stiffening = std::min(1 / flat.free, kMostMeshStiffening);
    const Eigen::Vector3d stiffness = rigidity * (flat.area * stiffening);
    const Triangle& corners = mesh.triangles[t];
    auto weights = curvature(corners, t, flat, edges, slopes);
    if (part.curved_at_rest) {
      const Eigen::Vector3d rest = lift_off(corners, mesh.x, weights);
      append(corners, weights, rest, stiffness, flat.area, part.rest_curves);
    }
    matrix.add(weights, stiffness);
    if (part.bending_time > 0) append(t, weights, stiffness, part.curvatures);
  }
  part.bending_links = matrix.links();
  part.bending_stencils = part.bending_links.size();
}

template void bend_by_links(const ClothModel<float>&, ClothPart<float>&);
template void bend_by_links(const ClothModel<double>&, ClothPart<double>&);

}  // namespace weft
