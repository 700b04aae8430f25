// Copies from the model what the guard needs of the cloths, and answers questions about the fabric.

#include "core/contact/guard/guarded_cloths.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/contact/guard/constants.h"
#include "core/contact/guard/nearer_neighbour.h"
#include "core/geometry/triangle_sides.h"
#include "core/instantiate.h"

namespace weft {
namespace {

std::vector<std::array<Index, 3>> particles_across(const std::vector<Triangle>& triangles) {
  std::vector<std::array<Index, 3>> across(triangles.size(), {kNone, kNone, kNone});
  const std::vector<TriangleSide> sides = sorted_sides(triangles);
  const auto at = [](const TriangleSide& side, auto& list) -> auto& {
    return list[at_index(side.triangle)][at_index(side.corner)];
  };
  for (std::size_t n = 0; n + 1 < sides.size(); ++n) {
    const TriangleSide &one = sides[n], &other = sides[n + 1];
    if (one.ends != other.ends) continue;
    at(one, across) = at(other, triangles);
    at(other, across) = at(one, triangles);
  }
  return across;
}

/// Length of a cloth's edges [m]; on a mesh, where they vary, less than their mean.
template <class Real>
Real cell_of(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  double sum = 0;
  for (Index e = part.edges.first; e < part.edges.end(); ++e) {
    const Edge& edge = model.edges[at_index(e)];
    sum += static_cast<double>(
        (model.rest_positions[at_index(edge[0])] - model.rest_positions[at_index(edge[1])]).norm());
  }
  const double cell =
      part.rows > 0 ? std::min(static_cast<double>(part.cell_u), static_cast<double>(part.cell_v))
                    : kMeshCell * sum / std::max<Index>(part.edges.count, 1);
  return static_cast<Real>(cell);
}

/// Whether features of one cloth may be near in the fabric.
/// @param i, j       a particle of either
/// @param thickness  of the cloth [m]
template <class Real>
bool may_be_near(const GuardedCloths<Real>& cloths, Index i, Index j, Real thickness, Index cloth) {
  const Real near = 2 * thickness + 2 * cloths.cell[at_index(cloth)];
  const Quad<Real> apart = cloths.rest_positions[at_index(i)] - cloths.rest_positions[at_index(j)];
  return dot(apart, apart) <= near * near;
}

/// Whether the nearest point of a triangle is the nearest of the surface around it.
/// @param particles  the one that is near, and the triangle's corners
template <class Real>
bool triangle_owns_nearest(const GuardedCloths<Real>& cloths, const QuadArray<Real>& x,
                           Index triangle, const std::array<Index, 4>& particles,
                           const PairSeparation<Real>& s) {
  assert(at_index(triangle) < cloths.across.size());
  Quad<Real> nearest;
  std::size_t corner = 3, zeros = 0, kept = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    nearest += x[at_index(particles[k + 1])] * -s.weight[k + 1];
    if (s.weight[k + 1] == 0) {
      corner = k;
      ++zeros;
    } else {
      kept = k;
    }
  }
  const Quad<Real> away = x[at_index(particles[0])] - nearest;
  const auto leads_nearer = [&](Index i) {
    return i != particles[0] && dot(away, x[at_index(i)] - nearest) > 0;
  };
  if (zeros == 1) {
    const Index other = cloths.across[at_index(triangle)][corner];
    return other == kNone || !leads_nearer(other);
  }
  if (zeros != 2) return true;
  const auto around = cloths.neighbours.of(at_index(particles[kept + 1]));
  return std::none_of(around.begin(), around.end(),
                      [&](const auto& neighbour) { return leads_nearer(neighbour.particle); });
}

}  // namespace

template <class Real>
GuardedCloths<Real> guarded_cloths(const ClothModel<Real>& model) {
  assert(!model.parts.empty() && model.rest_positions.size() == model.mass.size());
  GuardedCloths<Real> cloths;
  cloths.edges = model.edges;
  cloths.triangles = model.triangles;
  cloths.across = particles_across(model.triangles);
  cloths.neighbours = Neighbours(model.mass.size(), model.edges);
  for (const Vec3<Real>& p : model.rest_positions) cloths.rest_positions.push_back(to_quad(p));
  cloths.finest = std::numeric_limits<Real>::infinity();
  for (const ClothPart<Real>& part : model.parts) {
    cloths.particles_of.push_back(part.particles);
    cloths.thickness.push_back(static_cast<Real>(part.fabric.thickness));
    cloths.friction.push_back(static_cast<Real>(part.fabric.friction));
    cloths.cell.push_back(cell_of(model, part));
    cloths.thickest = std::max(cloths.thickest, cloths.thickness.back());
    cloths.finest = std::min(cloths.finest, cloths.cell.back());
    for (Index i = part.particles.first; i < part.particles.end(); ++i)
      cloths.inverse_area.push_back(static_cast<Real>(part.fabric.areal_density) /
                                    model.mass[at_index(i)]);
  }
  cloths.reach = std::min(cloths.thickest * Real(kReachPart), cloths.finest * Real(kMostReach));
  cloths.reach = std::max(cloths.reach, cloths.finest * Real(kLeastReach));
  cloths.margin = std::max(Real(0), cloths.thickest * Real(kSightPart) - cloths.reach);
  return cloths;
}

template <class Real>
Index cloth_of(const GuardedCloths<Real>& cloths, Index particle) {
  assert(particle >= 0 && particle < cloths.particles_of.back().end());
  std::size_t cloth = cloths.particles_of.size() - 1;
  while (cloth > 0 && particle < cloths.particles_of[cloth].first) --cloth;
  return static_cast<Index>(cloth);
}

template <class Real>
Real kept_distance(const GuardedCloths<Real>& cloths, const GuardedPair<Real>& pair, Index p,
                   Index q) {
  Real distance = (cloths.thickness[at_index(p)] + cloths.thickness[at_index(q)]) / 2;
  if (pair.kind == PairKind::edge_edge) distance *= Real(kEdgeRadius);
  if (p != q) return distance;
  if (!may_be_near(cloths, pair.particle[0], pair.particle[2], distance, p)) return distance;
  const PairPoints<Real> rest = points_of(pair, cloths.rest_positions);
  return std::min({distance, separate_pair(pair.kind, rest).gap * Real(kFabricPart),
                   cloths.reach * Real(kSeenPart)});
}

template <class Real>
Real seen_from(const GuardedCloths<Real>& cloths, const std::array<Index, 4>& particles) {
  const Index p = cloth_of(cloths, particles[0]), q = cloth_of(cloths, particles[2]);
  const Real thickness = (cloths.thickness[at_index(p)] + cloths.thickness[at_index(q)]) / 2;
  if (p == q && may_be_near(cloths, particles[0], particles[2], thickness, p)) return 0;
  return thickness * Real(2 * kSightPart);
}

template <class Real>
bool own_nearest(const GuardedCloths<Real>& cloths, const QuadArray<Real>& x, Index triangle,
                 const std::array<Index, 4>& particles, const PairSeparation<Real>& s,
                 bool pushes) {
  const Real most = static_cast<Real>(pushes ? kStillNearest : kLeadsNearer);
  return s.inside || (triangle_owns_nearest(cloths, x, triangle, particles, s) &&
                      !has_nearer_neighbour(cloths, x, particles[0], particles,
                                            to_quad<Real>(-s.normal), most));
}

WEFT_INSTANTIATE_FUNCTIONS(guarded_cloths, cloth_of, seen_from, kept_distance, own_nearest)

}  // namespace weft
