// Prepares a triangle mesh for contact.

#include "core/contact/objects/mesh_shape.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <initializer_list>

#include "core/contact/objects/apart.h"
#include "core/instantiate.h"
#include "core/math/angle.h"

namespace weft {
namespace {

/// What all ridges that count as flat rise together at most, across the whole mesh: less than what
/// contact leaves between the cloth and an object [m].
constexpr double kFlatRise = 2e-6;

/// Squared distances from boxes may come out too large by this factor.
constexpr double kBoxRounding = 1 + 1e-5;

/// Angle by which a closed surface turns outwards at an edge [rad]; negative if it is a groove.
double outward_turn(const TriangleMesh& mesh, const MeshEdge& edge) {
  const Vec3d n1 = unit_normal(mesh, edge.triangle[0]), n2 = unit_normal(mesh, edge.triangle[1]);
  const Triangle& second = mesh.triangles[at_index(edge.triangle[1])];
  Index opposite = second[0];
  for (const Index i : second) {
    if (i != edge.a && i != edge.b) opposite = i;
  }
  const Vec3d across = mesh.positions[at_index(opposite)] - mesh.positions[at_index(edge.a)];
  const double turn = angle_of(n1.cross(n2).norm(), n1.dot(n2));
  return n1.dot(across) < 0 ? turn : -turn;
}

/// Width of a triangle across one of its edges [m].
double width_across(const TriangleMesh& mesh, Index triangle, const MeshEdge& edge) {
  const auto at = [&](Index i) { return mesh.positions[at_index(i)]; };
  const Triangle& t = mesh.triangles[at_index(triangle)];
  const double doubled_area = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm();
  return doubled_area / (at(edge.b) - at(edge.a)).norm();
}

/// How steep the faces about each vertex fall from it, as a slope; less where some of them rise.
std::vector<double> slopes_at_vertices(const TriangleMesh& mesh) {
  const std::vector<Vec3d> normals = vertex_normals(mesh);
  std::vector<double> slopes(mesh.positions.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d n = unit_normal(mesh, static_cast<Index>(t));
    for (const Index i : mesh.triangles[t]) {
      const Vec3d& up = normals[at_index(i)];
      const double along = n.dot(up);
      const double slope = along > 0 ? n.cross(up).norm() / along : INFINITY;
      slopes[at_index(i)] = std::max(slopes[at_index(i)], slope);
    }
  }
  return slopes;
}

/// @param slope  of the steeper of its ends
Rise<double> rise_of(const TriangleMesh& mesh, const MeshEdge& edge, double slope) {
  const double turn = outward_turn(mesh, edge);
  const double width = std::min(width_across(mesh, edge.triangle[0], edge),
                                width_across(mesh, edge.triangle[1], edge));
  return {std::max(std::tan(turn / 2), slope), turn / width};
}

/// Angle up to which ridges of a closed mesh are flat [rad]: the least angles that rise together by
/// no more than `kFlatRise`.
double flat_turn(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges) {
  std::vector<double> turns;
  for (const MeshEdge& edge : edges) {
    if (edge.triangle[1] != kNone) turns.push_back(outward_turn(mesh, edge));
  }
  Aabb<double> box;
  for (const Vec3d& p : mesh.positions) box.add(p);
  const double most = kFlatRise / (box.upper - box.lower).norm();
  std::sort(turns.begin(), turns.end());
  double sum = 0, flat = 0;
  for (const double turn : turns) {
    sum += std::max(turn, 0.0);
    if (sum > most) break;
    flat = std::max(turn, 0.0);
  }
  return flat;
}

/// The triangle that each sharp edge and vertex of a mesh is with; kNone for others.
struct SharpFeatures {
  std::vector<Index> of_edge, of_vertex;
};

template <class Real>
SharpFeatures find_sharp_features(const TriangleMesh& mesh, MeshShape<Real>& shape) {
  const std::vector<double> slopes = slopes_at_vertices(mesh);
  const double flat = shape.closed ? flat_turn(mesh, shape.edges) : 0;
  shape.edge_rises.resize(shape.edges.size());
  shape.vertex_rises.resize(mesh.positions.size());
  SharpFeatures sharp{std::vector<Index>(shape.edges.size(), kNone),
                      std::vector<Index>(mesh.positions.size(), kNone)};
  for (std::size_t e = 0; e < shape.edges.size(); ++e) {
    const MeshEdge& edge = shape.edges[e];
    const bool rim = edge.triangle[1] == kNone;
    const Vec3d n1 = unit_normal(mesh, edge.triangle[0]);
    const Vec3d n2 = rim ? n1 : unit_normal(mesh, edge.triangle[1]);
    const Vec3d sum = n1 + n2;
    shape.edge_normals.push_back(
        (sum.norm() > 1e-6 ? sum.normalized().eval() : n1).template cast<Real>());
    const bool solid = shape.closed && !rim;
    if (solid && outward_turn(mesh, edge) <= flat) continue;
    const auto a = at_index(edge.a), b = at_index(edge.b);
    const Rise<double> rise =
        solid ? rise_of(mesh, edge, std::max(slopes[a], slopes[b])) : Rise<double>{INFINITY, 0};
    shape.edge_rises[e] = {static_cast<Real>(rise.slope), static_cast<Real>(rise.curvature)};
    sharp.of_edge[e] = edge.triangle[0];
    for (const std::size_t v : {a, b}) {
      Rise<Real>& of_corner = shape.vertex_rises[v];
      of_corner.slope = static_cast<Real>(solid ? slopes[v] : INFINITY);
      of_corner.curvature = std::max(of_corner.curvature, shape.edge_rises[e].curvature);
      sharp.of_vertex[v] = edge.triangle[0];
    }
  }
  return sharp;
}

template <class Real>
void build_tree(MeshShape<Real>& shape) {
  std::vector<Aabb<Real>> boxes;
  for (const Triangle& t : shape.triangles) {
    boxes.emplace_back();
    for (const Index i : t) boxes.back().add(shape.positions[at_index(i)]);
  }
  shape.triangle_tree.build(boxes);
}

/// Features in the order of the triangles that they are with; without those that are with none.
/// @param place  of each triangle
std::vector<Index> sorted_by_place(const std::vector<Index>& triangle_of,
                                   const std::vector<std::size_t>& place) {
  std::vector<Index> sorted;
  for (std::size_t f = 0; f < triangle_of.size(); ++f) {
    if (triangle_of[f] != kNone) sorted.push_back(static_cast<Index>(f));
  }
  const auto place_of = [&](Index f) { return place[at_index(triangle_of[at_index(f)])]; };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](Index f, Index g) { return place_of(f) < place_of(g); });
  return sorted;
}

/// Puts the features in blocks, in the order in which the tree has the triangles.
template <class Real>
void build_blocks(const SharpFeatures& sharp, MeshShape<Real>& shape) {
  std::vector<Index> order;
  shape.triangle_tree.for_each_overlap(shape.triangle_tree.bounds(),
                                       [&](Index t) { order.push_back(t); });
  assert(order.size() == shape.triangles.size());
  std::vector<std::size_t> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[at_index(order[k])] = k;
  const auto at = [&](Index v) { return shape.positions[at_index(v)]; };
  const auto triangle = [&](Index t) { return shape.triangles[at_index(t)]; };
  const auto edge = [&](Index e) { return shape.edges[at_index(e)]; };
  const auto box_of = [&](std::initializer_list<Index> vertices) {
    Aabb<Real> box;
    for (const Index v : vertices) box.add(at(v));
    return box;
  };
  using Vectors2 = std::array<Vec3<Real>, 2>;
  using Vectors3 = std::array<Vec3<Real>, 3>;
  shape.triangle_blocks = in_blocks<Real>(
      order, kTriangleNumbers,
      [&](Index t) {
        const auto [a, b, c] = triangle(t);
        return Vectors3{at(a), at(b) - at(a), at(c) - at(a)};
      },
      [&](Index t) {
        return box_of({triangle(t)[0], triangle(t)[1], triangle(t)[2]});
      });
  prepare_triangles(shape.triangle_blocks.boxes.size(), shape.triangle_blocks.values.data());
  shape.ridge_blocks = in_blocks<Real>(
      sorted_by_place(sharp.of_edge, place), 6,
      [&](Index e) {
        return Vectors2{at(edge(e).a), at(edge(e).b) - at(edge(e).a)};
      },
      [&](Index e) {
        return box_of({edge(e).a, edge(e).b});
      });
  shape.corner_blocks = in_blocks<Real>(
      sorted_by_place(sharp.of_vertex, place), 3,
      [&](Index v) { return std::array<Vec3<Real>, 1>{at(v)}; },
      [&](Index v) { return box_of({v}); });
}

/// Normal of the feature of triangle t that is nearest: face, corner, or edge.
template <class Real>
Vec3<Real> feature_normal(const MeshShape<Real>& mesh, Index t, int feature) {
  const Triangle& triangle = mesh.triangles[at_index(t)];
  if (feature == 0) return mesh.face_normals[at_index(t)];
  if (feature <= 3) return mesh.vertex_normals[at_index(triangle[at_index(feature - 1)])];
  const auto k = at_index(feature - 4);
  const Index i = triangle[k], j = triangle[(k + 1) % 3];
  // Edges are ordered by their ends.
  const auto found =
      std::lower_bound(mesh.edges.begin(), mesh.edges.end(), Edge{std::min(i, j), std::max(i, j)},
                       [](const MeshEdge& e, const Edge& ends) {
                         return Edge{e.a, e.b} < ends;
                       });
  return mesh.edge_normals[static_cast<std::size_t>(found - mesh.edges.begin())];
}

}  // namespace

template <class Real>
MeshShape<Real> prepare_mesh(const TriangleMesh& mesh) {
  assert(!mesh.triangles.empty());
  MeshShape<Real> shape;
  shape.closed = is_closed(mesh);
  shape.triangle_size = static_cast<Real>(
      std::sqrt(2 * surface_area(mesh) / static_cast<double>(mesh.triangles.size())));
  shape.triangles = mesh.triangles;
  for (const Vec3d& p : mesh.positions) shape.positions.push_back(p.cast<Real>());
  for (const Vec3d& n : vertex_normals(mesh)) shape.vertex_normals.push_back(n.cast<Real>());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    shape.face_normals.push_back(unit_normal(mesh, static_cast<Index>(t)).cast<Real>());
  shape.edges = edges_of(mesh);
  for (const MeshEdge& e : shape.edges) {
    const double length = (mesh.positions[at_index(e.a)] - mesh.positions[at_index(e.b)]).norm();
    shape.longest_edge = std::max(shape.longest_edge, static_cast<Real>(length));
  }
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t k) { return mesh.positions[at_index(t[k])]; };
    const Vec3d ab = at(1) - at(0), ac = at(2) - at(0);
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    shape.rounding = std::max(
        shape.rounding,
        rounding_of_triangle(static_cast<Real>(longest), static_cast<Real>(ab.cross(ac).norm())));
  }
  const SharpFeatures sharp = find_sharp_features(mesh, shape);
  build_tree(shape);
  build_blocks(sharp, shape);
  return shape;
}

/// In double precision: at a sharp ridge or corner a small error would change sides.
template <class Real>
MeshDistance<Real> distance_to_triangle(const MeshShape<Real>& mesh, Index t, const Vec3<Real>& p) {
  const Vec3d point = p.template cast<double>();
  const TrianglePoint<double> nearest = nearest_on(mesh, t, point);
  const Vec3d away = point - nearest.point;
  const double distance = away.norm();
  const Vec3<Real> outward = feature_normal(mesh, t, nearest.feature);
  MeshDistance<Real> result;
  result.triangle = t;
  result.feature = nearest.feature;
  const double sign = mesh.closed && away.dot(outward.template cast<double>()) < 0 ? -1 : 1;
  result.distance = static_cast<Real>(sign * distance);
  result.size = distance;
  result.normal = outward;  // serves where there is no direction
  if (distance > kNoDirection) result.normal = (away * (sign / distance)).template cast<Real>();
  return result;
}

template <class Real>
MeshDistance<Real> distance_to_mesh(const MeshShape<Real>& mesh, const Vec3<Real>& p, Real reach) {
  assert(reach >= 0);
  // The nearest triangle in double precision: a thin one that only comes out nearest may tell the
  // wrong side.
  const Vec3d point = p.template cast<double>();
  Index best = kNone;
  double least = static_cast<double>(reach) * static_cast<double>(reach);
  mesh.triangle_tree.nearest(
      reach * reach, [&](const Aabb<Real>& box) { return box.squared_distance(p); },
      [&](Index t, Real bound) {
        const double d2 = (point - nearest_on(mesh, t, point).point).squaredNorm();
        if (d2 > least || (d2 == least && best != kNone && t > best)) return bound;
        best = t;
        least = d2;
        return std::min(bound, static_cast<Real>(d2 * kBoxRounding));
      });
  if (best == kNone) return {};
  return distance_to_triangle(mesh, best, p);
}

WEFT_INSTANTIATE_FUNCTIONS(prepare_mesh, distance_to_triangle, distance_to_mesh)

}  // namespace weft
