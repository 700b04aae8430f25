// Checks a cloth's mesh and builds its membrane, hinges and masses.

#include "core/cloth/mesh_cloth.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "core/cloth/constants.h"
#include "core/cloth/corner_places.h"
#include "core/cloth/flat_rest.h"
#include "core/cloth/grid_cloth.h"
#include "core/cloth/hinges.h"
#include "core/cloth/membrane.h"
#include "core/cloth/mesh_bending.h"
#include "core/cloth/mesh_uv.h"
#include "core/cloth/stability_bound.h"
#include "core/error.h"

namespace weft {
namespace {

std::string at(const char* list, std::size_t index) {
  return std::string("cloth.mesh.") + list + "[" + std::to_string(index) + "]";
}

/// Compares positions as they will be stored: coincident ones would make springs without length.
template <class Real>
void refuse_unused_and_coincident(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const Index i : t) used[static_cast<std::size_t>(i)] = true;
  }
  std::map<std::array<Real, 3>, std::size_t> places;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!used[i])
      throw DefinitionError(at("positions", i), "in no triangle", "only vertices of triangles",
                            "a particle without a triangle is not part of a cloth");
    const Vec3<Real> p = mesh.positions[i].template cast<Real>();
    const auto [there, is_new] = places.insert({{p[0], p[1], p[2]}, i});
    if (!is_new)
      throw DefinitionError(at("positions", i),
                            "where vertex " + std::to_string(there->second) + " is",
                            "vertices at different places", "merge vertices that coincide");
  }
}

void refuse_crowded_edges(const TriangleMesh& mesh) {
  struct Beside {
    int triangles = 0;
    Index opposite = kNone;
  };
  std::map<Edge, Beside> edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      const Index opposite = mesh.triangles[t][(k + 2) % 3];
      Beside& beside = edges[{std::min(a, b), std::max(a, b)}];
      const std::string edge = "edge " + std::to_string(a) + "-" + std::to_string(b);
      if (++beside.triangles > 2)
        throw DefinitionError(at("triangles", t), "third at " + edge,
                              "at most two triangles at an edge", "a cloth is a surface");
      if (beside.opposite == opposite)
        throw DefinitionError(at("triangles", t), "a repeated triangle", "each triangle once",
                              "remove double triangles");
      beside.opposite = opposite;
    }
  }
}

/// cos^2 of the angle between an edge and the warp.
double squared_cosine(double du, double dv) {
  const double d2 = du * du + dv * dv;
  return d2 > 0 ? du * du / d2 : 0.5;
}

double stiffness_along(const FabricDef& f, double cos2) {
  const double sin2 = 1 - cos2;
  return f.stretch_warp * cos2 * cos2 + f.stretch_weft * sin2 * sin2 + 6 * f.shear * sin2 * cos2;
}

/// A triangle of the mesh with the particles at its corners.
struct PlacedTriangle {
  Triangle particles;
  std::size_t old = 0;  ///< its number in the mesh
  double area = 0;      ///< at rest [m^2]

  Index first() const { return *std::min_element(particles.begin(), particles.end()); }
};

template <class Real>
std::array<Real, 2> stored(const std::array<double, 2>& place) {
  return {static_cast<Real>(place[0]), static_cast<Real>(place[1])};
}

template <class Real>
void place_particles(const TriangleMesh& mesh, const MeshMaterial& material,
                     const std::vector<Index>& order, ClothModel<Real>& model) {
  const bool by_triangle = rests_by_triangle(model);
  assert(order.size() == mesh.positions.size());
  std::vector<Index> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto old = static_cast<std::size_t>(order[k]);
    place[old] = static_cast<Index>(k);
    model.rest_positions.push_back(mesh.positions[old].template cast<Real>());
    model.material.push_back(stored<Real>(material.of_vertices[old]));
  }
  const auto new_index = [&](Index old) { return place[static_cast<std::size_t>(old)]; };
  std::vector<PlacedTriangle> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& old = mesh.triangles[t];
    const auto x = [&](std::size_t k) -> const Vec3d& {
      return mesh.positions[static_cast<std::size_t>(old[k])];
    };
    const double area = by_triangle ? 0.5 * std::abs(doubled_area(material.of_corners[t]))
                                    : 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
    triangles.push_back({{new_index(old[0]), new_index(old[1]), new_index(old[2])}, t, area});
  }
  std::stable_sort(
      triangles.begin(), triangles.end(),
      [](const PlacedTriangle& a, const PlacedTriangle& b) { return a.first() < b.first(); });
  for (const PlacedTriangle& t : triangles) {
    model.triangles.push_back(t.particles);
    model.triangle_area.push_back(static_cast<Real>(t.area));
    if (material.of_corners.empty()) continue;
    const CornerUv& corners = material.of_corners[t.old];
    model.corner_material.push_back(
        {stored<Real>(corners[0]), stored<Real>(corners[1]), stored<Real>(corners[2])});
  }
}

template <class Real>
void lump_masses(const ClothDef& def, ClothModel<Real>& model) {
  std::vector<double> mass(model.rest_positions.size(), 0);
  double whole = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const double share = def.fabric.areal_density * static_cast<double>(model.triangle_area[t]) / 3;
    whole += 3 * share;
    for (const Index i : model.triangles[t]) mass[static_cast<std::size_t>(i)] += share;
  }
  if (def.mass_lumping == MassLumping::equal)
    std::fill(mass.begin(), mass.end(), whole / static_cast<double>(mass.size()));
  for (const double m : mass) {
    assert(m > 0);
    model.mass.push_back(static_cast<Real>(m));
  }
}

/// Y(a) of the edge in the fabric of one of its triangles [N/m].
template <class Real>
double stiffness_at(const TriangleSide& side, const FabricDef& fabric,
                    const ClothModel<Real>& model) {
  const auto [a, b] = stored_ends(model, side);
  return stiffness_along(
      fabric, squared_cosine(static_cast<double>(b[0] - a[0]), static_cast<double>(b[1] - a[1])));
}

/// Adds one spring per edge, in the order of the edges.
template <class Real>
void add_edge_springs(const FabricDef& fabric, ClothModel<Real>& model) {
  const std::vector<TriangleSide> sides = sorted_sides(model.triangles);
  const auto area_of = [&](const TriangleSide& side) {
    return static_cast<double>(model.triangle_area[static_cast<std::size_t>(side.triangle)]);
  };
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const TriangleSide& first = sides[s];
    const bool is_inner = s + 1 < sides.size() && sides[s + 1].ends == first.ends;
    const TriangleSide& second = is_inner ? sides[++s] : first;
    const double along = stiffness_at(first, fabric, model);
    // Sum of Y A, in a form that is exact where both triangles have the same Y.
    const double pull = is_inner
                            ? along * (area_of(first) + area_of(second)) +
                                  (stiffness_at(second, fabric, model) - along) * area_of(second)
                            : along * area_of(first);
    const double length2 = rest_length2(model, first, second);
    const double stiffness = pull / length2;
    assert(length2 > 0 && stiffness >= 0);
    if (stiffness == 0) continue;
    Spring<Real> spring;
    spring.i = first.ends[0];
    spring.j = first.ends[1];
    spring.rest_length = static_cast<Real>(std::sqrt(length2));
    spring.stiffness = static_cast<Real>(stiffness);
    model.springs.push_back(spring);
    model.spring_kinds.push_back(SpringKind::edge);
  }
}

/// Edges stretch and shear in one, and have the larger of both relaxation times.
template <class Real>
void add_edge_damping(ClothModel<Real>& model, ClothPart<Real>& part) {
  const FabricDef& f = part.fabric;
  const double time = std::max({f.stretch_damping, f.shear_damping, least_relaxation_time(part)});
  add_spring_damping({time, time, time}, model, part);
}

/// Adds one membrane triangle per triangle, at rest as it lies and with the material's directions,
/// or as it lies in the fabric.
template <class Real>
void add_membrane(const FabricDef& fabric, ClothModel<Real>& model) {
  refuse_indefinite_membrane(fabric);
  MembraneTensor<Real>& tensor = model.parts.front().membrane_tensor;
  tensor.warp = static_cast<Real>(fabric.stretch_warp);
  tensor.weft = static_cast<Real>(fabric.stretch_weft);
  tensor.coupling = static_cast<Real>(membrane_coupling(fabric));
  tensor.shear = static_cast<Real>(fabric.shear);
  const bool by_triangle = rests_by_triangle(model);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    std::array<Vec3d, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(model.triangles[t][k]);
      x[k] = model.rest_positions[i].template cast<double>();
    }
    const RestCorners material = corner_places(model, static_cast<Index>(t));
    if (by_triangle && doubled_area(material) == 0)
      throw DefinitionError("cloth.mesh.uv", "a triangle that is a line in the solver's precision",
                            "triangles with an area", "move the uv nearer to zero");
    if (!((x[1] - x[0]).cross(x[2] - x[0]).norm() > 0))
      throw DefinitionError("cloth.mesh", "a triangle that is a line in the solver's precision",
                            "triangles with an area", "move the mesh nearer to the origin");
    model.membrane.push_back(membrane_triangle<Real>(
        model.triangles[t], by_triangle ? material : laid_flat(x, material)));
  }
}

/// Keeps the hinges or replaces them by the quadratic form.
template <class Real>
void choose_bending(const ClothDef& def, ClothModel<Real>& model) {
  const bool wanted = def.bending_model == BendingModel::quadratic;
  const bool may = def.bending_model == BendingModel::automatic && quadratic_bending_fits(def);
  const bool by_triangle = rests_by_triangle(model);
  if (model.hinges.empty() || !(wanted || may)) return;
  ClothPart<Real>& part = model.parts.front();
  double most = 0;
  for (const Hinge<Real>& hinge : model.hinges)
    most = std::max(most, std::abs(static_cast<double>(hinge.rest_angle)));
  part.curved_at_rest = !by_triangle && most > kFlatRestAngle && !lies_flat(model);
  part.bends_by_links = true;
  part.bending_time = static_cast<Real>(part.fabric.bending_damping);
  bend_by_links(model, part);
  model.hinges.clear();
  part.hinges = {};
  bound_quadratic_bending(model, part);
}

}  // namespace

std::vector<Index> breadth_first_order(std::size_t vertices,
                                       const std::vector<Triangle>& triangles) {
  std::vector<std::vector<Index>> neighbours(vertices);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t other : {(k + 1) % 3, (k + 2) % 3})
        neighbours[static_cast<std::size_t>(t[k])].push_back(t[other]);
    }
  }
  std::vector<Index> order;
  std::vector<bool> seen(vertices, false);
  const auto visit = [&](Index i) {
    if (seen[static_cast<std::size_t>(i)]) return;
    seen[static_cast<std::size_t>(i)] = true;
    order.push_back(i);
  };
  std::size_t next = 0;
  for (std::size_t start = 0; start < vertices; ++start) {
    visit(static_cast<Index>(start));
    for (; next < order.size(); ++next) {
      std::vector<Index>& beside = neighbours[static_cast<std::size_t>(order[next])];
      std::sort(beside.begin(), beside.end());
      for (const Index i : beside) visit(i);
    }
  }
  assert(order.size() == vertices);
  return order;
}

namespace {

/// A cloth at rest as its mesh lies; or, of a mesh with seams whose rest shape is its uv, as each
/// of its triangles lies there.
template <class Real>
ClothModel<Real> build_placed(const ClothDef& def) {
  assert(def.mesh);
  const TriangleMesh& mesh = def.mesh->mesh;
  validate(mesh, "cloth.mesh.");
  refuse_unused_and_coincident<Real>(mesh);
  refuse_crowded_edges(mesh);
  refuse_other_uv(*def.mesh);
  ClothModel<Real> model;
  model.parts.emplace_back();
  ClothPart<Real>& part = model.parts.front();
  part.rests_by_triangle = def.rest_shape == RestShape::uv && has_seams(*def.mesh);
  place_particles(mesh, part.rests_by_triangle ? pieces_of(*def.mesh) : material_of(*def.mesh),
                  breadth_first_order(mesh.positions.size(), mesh.triangles), model);
  lump_masses(def, model);
  const FabricDef& fabric = def.fabric;
  connect_triangles(
      {def.rest_angle, true, fabric.bending_damping, def.bending_model == BendingModel::sine_hinges,
       [&](double du, double dv) {
         // An edge along v bends with curvature along u.
         const double cos2 = squared_cosine(du, dv);
         return fabric.bending_weft * cos2 + fabric.bending_warp * (1 - cos2);
       }},
      model);
  const bool triangles = has_membrane_triangles(def);
  if (triangles)
    add_membrane(fabric, model);
  else
    add_edge_springs(fabric, model);
  complete_part(def, model);
  bound_springs(model, part);
  bound_hinges(model, part);
  if (triangles)
    bound_membrane(model, part);
  else
    add_edge_damping(model, part);
  choose_bending(def, model);
  return model;
}

}  // namespace

template <class Real>
ClothModel<Real> build_mesh_cloth(const ClothDef& def) {
  assert(def.mesh);
  if (def.rest_shape == RestShape::placed) return build_placed<Real>(def);
  const TriangleMesh& mesh = def.mesh->mesh;
  validate(mesh, "cloth.mesh.");
  refuse_unused_and_coincident<Real>(mesh);
  refuse_other_uv(*def.mesh);
  if (has_seams(*def.mesh)) return build_placed<Real>(def);
  ClothModel<Real> model;
  try {
    model = build_placed<Real>(laid_out(def));
  } catch (const DefinitionError& error) {
    const std::string places = "cloth.mesh.positions";
    if (!error.field.starts_with(places)) throw;
    throw error.renamed("cloth.mesh.uv" + error.field.substr(places.size()));
  }
  for (const Index i : breadth_first_order(mesh.positions.size(), mesh.triangles))
    model.start_positions.push_back(
        mesh.positions[static_cast<std::size_t>(i)].template cast<Real>());
  return model;
}

template ClothModel<float> build_mesh_cloth<float>(const ClothDef&);
template ClothModel<double> build_mesh_cloth<double>(const ClothDef&);

}  // namespace weft
