// Builds models of one or several cloths from their definitions.

#include "core/cloth/cloth_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/cloth/constants.h"
#include "core/cloth/corner_places.h"
#include "core/cloth/cut_grid.h"
#include "core/cloth/grid_cloth.h"
#include "core/cloth/mesh_cloth.h"
#include "core/cloth/pieces.h"
#include "core/cloth/stability_bound.h"
#include "core/cloth/thread_locks.h"
#include "core/error.h"
#include "core/geometry/aabb.h"

namespace weft {
namespace {

template <class T>
IndexRange append(std::vector<T>& to, const std::vector<T>& from) {
  const IndexRange range{static_cast<Index>(to.size()), static_cast<Index>(from.size())};
  to.insert(to.end(), from.begin(), from.end());
  return range;
}

/// Gives the triangles places of their own, of a model that had none.
template <class Real>
void fill_corners(ClothModel<Real>& model) {
  if (!model.corner_material.empty()) return;
  std::vector<std::array<std::array<Real, 2>, 3>> corners;
  for (Index t = 0; t < static_cast<Index>(model.triangles.size()); ++t)
    corners.push_back(stored_corners(model, t));
  model.corner_material = std::move(corners);
}

/// Appends a cloth to a model, with its indices shifted.
template <class Real>
void append_cloth(ClothModel<Real>&& cloth, ClothModel<Real>& model) {
  assert(cloth.parts.size() == 1);
  if (!cloth.corner_material.empty() || !model.corner_material.empty()) {
    fill_corners(cloth);
    fill_corners(model);
  }
  const Index shift = model.particle_count();
  for (Triangle& triangle : cloth.triangles) {
    for (Index& corner : triangle) corner += shift;
  }
  for (Edge& edge : cloth.edges) {
    for (Index& end : edge) end += shift;
  }
  for (Spring<Real>& spring : cloth.springs) {
    spring.i += shift;
    spring.j += shift;
  }
  for (MembraneTriangle<Real>& triangle : cloth.membrane) {
    for (Index& corner : triangle.x) corner += shift;
  }
  for (ThreadLock<Real>& lock : cloth.locks) {
    for (Index& corner : lock.x) corner += shift;
  }
  for (Hinge<Real>& hinge : cloth.hinges) {
    for (Index& corner : hinge.x) corner += shift;
  }
  ClothPart<Real>& part = cloth.parts.front();
  append(model.rest_positions, cloth.rest_positions);
  append(model.start_positions, cloth.start_positions);
  append(model.material, cloth.material);
  append(model.corner_material, cloth.corner_material);
  append(model.triangle_area, cloth.triangle_area);
  append(model.spring_kinds, cloth.spring_kinds);
  part.particles = append(model.mass, cloth.mass);
  part.triangles = append(model.triangles, cloth.triangles);
  part.edges = append(model.edges, cloth.edges);
  part.springs = append(model.springs, cloth.springs);
  part.hinges = append(model.hinges, cloth.hinges);
  part.membrane = append(model.membrane, cloth.membrane);
  part.locks = append(model.locks, cloth.locks);
  model.parts.push_back(std::move(part));
}

template <class Real>
ClothModel<Real> build_by_kind(const ClothDef& def) {
  if (def.mesh) return build_mesh_cloth<Real>(def);
  return def.outline == Outline::rectangle ? build_grid_cloth<Real>(def)
                                           : build_cut_grid<Real>(def);
}

}  // namespace

template <class Real>
ClothModel<Real> build_cloth(const ClothDef& def) {
  validate(def);
  ClothModel<Real> model = build_by_kind<Real>(def);
  if (model.start_positions.empty()) model.start_positions = model.rest_positions;
  Aabb<Real> box;
  for (const Vec3<Real>& x : model.rest_positions) box.add(x);
  add_thread_locks(model);
  bound_damped_area(model, model.parts.front());
  model.parts.front().rest_diagonal = (box.upper - box.lower).norm();
  return model;
}

template <class Real>
ClothModel<Real> build_cloths(const std::vector<ClothDef>& defs) {
  assert(!defs.empty());
  ClothModel<Real> model = build_cloth<Real>(defs.front());
  for (std::size_t k = 1; k < defs.size(); ++k) {
    try {
      append_cloth(build_cloth<Real>(defs[k]), model);
    } catch (const DefinitionError& error) {
      throw error.renamed(cloth_field(k, error.field));
    }
  }
  return model;
}

template <class Real>
const ClothPart<Real>& part_of_particle(const ClothModel<Real>& model, Index particle) {
  assert(particle >= 0 && particle < model.particle_count());
  const auto after = std::upper_bound(
      model.parts.begin(), model.parts.end(), particle,
      [](Index i, const ClothPart<Real>& part) { return i < part.particles.first; });
  return *std::prev(after);
}

template <class Real>
std::vector<Index> joined_near(const ClothModel<Real>& model, std::span<const Index> start,
                               const std::function<bool(Index)>& is_near) {
  assert(!start.empty());
  const ClothPart<Real>& part = part_of_particle(model, start.front());
  std::vector<Edge> near;
  for (const Index i : start.subspan(1)) near.push_back({start.front(), i});
  for (Index e = part.edges.first; e < part.edges.end(); ++e) {
    const Edge& edge = model.edges[static_cast<std::size_t>(e)];
    if (is_near(edge[0]) || is_near(edge[1])) near.push_back(edge);
  }
  const std::vector<Index> piece_of = pieces_along(near, model.mass.size());
  const auto piece = [&](Index i) { return piece_of[static_cast<std::size_t>(i)]; };
  std::vector<Index> joined;
  for (Index i = part.particles.first; i < part.particles.end(); ++i)
    if (piece(i) == piece(start.front()) && is_near(i)) joined.push_back(i);
  return joined;
}

double disc_slack(const std::array<double, 2>& middle, double radius) {
  assert(radius >= 0);
  return kDiscSlack * radius + kPlaceSlack * std::hypot(middle[0], middle[1]);
}

template <class Real>
std::vector<Index> particles_in_disc(const ClothModel<Real>& model, Index centre, double radius) {
  assert(centre >= 0 && centre < model.particle_count());
  assert(radius >= 0);
  if (radius == 0) return {centre};
  const auto place_of = [&model](Index i) -> std::array<double, 2> {
    const auto& place = model.material[static_cast<std::size_t>(i)];
    return {static_cast<double>(place[0]), static_cast<double>(place[1])};
  };
  const std::array<double, 2> middle = place_of(centre);
  const double most = radius + disc_slack(middle, radius);
  const std::array<Index, 1> start = {centre};
  return joined_near(model, start, [&](Index i) {
    const std::array<double, 2> place = place_of(i);
    return i == centre || std::hypot(place[0] - middle[0], place[1] - middle[1]) <= most;
  });
}

#define WEFT_INSTANTIATE(Real)                                                             \
  template ClothModel<Real> build_cloth<Real>(const ClothDef&);                            \
  template ClothModel<Real> build_cloths<Real>(const std::vector<ClothDef>&);              \
  template const ClothPart<Real>& part_of_particle(const ClothModel<Real>&, Index);        \
  template std::vector<Index> joined_near(const ClothModel<Real>&, std::span<const Index>, \
                                          const std::function<bool(Index)>&);              \
  template std::vector<Index> particles_in_disc(const ClothModel<Real>&, Index, double);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
