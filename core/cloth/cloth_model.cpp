#include "core/cloth/cloth_model.h"

#include <algorithm>
#include <cmath>

#include "core/cloth/grid_springs.h"
#include "core/error.h"
#include "core/forces/hinge.h"
#include "core/solver/substep_rule.h"

namespace weft {
namespace {

/// An edge as one triangle sees it, for finding the other triangle.
struct TriangleSide {
  Index low, high;  // ends, sorted
  Index triangle;
  int corner;  // the corner opposite to the edge
  bool operator<(const TriangleSide& o) const {
    if (low != o.low) return low < o.low;
    return high != o.high ? high < o.high : triangle < o.triangle;
  }
};

std::vector<TriangleSide> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<TriangleSide> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto a = triangles[t][static_cast<std::size_t>((corner + 1) % 3)];
      const auto b = triangles[t][static_cast<std::size_t>((corner + 2) % 3)];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t), corner});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

template <class Real>
void place_particles(const ClothDef& def, ClothModel<Real>& model) {
  const Vec3d u = def.u.normalized(), v = def.v.normalized();
  for (int r = 0; r < def.rows; ++r) {
    for (int c = 0; c < def.columns; ++c) {
      const double s = def.width * c / (def.columns - 1), t = def.height * r / (def.rows - 1);
      model.rest_positions.push_back((def.origin + s * u + t * v).template cast<Real>());
      model.material.push_back({static_cast<Real>(s), static_cast<Real>(t)});
    }
  }
}

/// Half a cell's share on border lines and a quarter on corners, or the same for all.
template <class Real>
void lump_masses(const ClothDef& def, ClothModel<Real>& model) {
  const double total = def.fabric.areal_density * def.width * def.height;
  for (int r = 0; r < def.rows; ++r) {
    for (int c = 0; c < def.columns; ++c) {
      const double share =
          (r == 0 || r == def.rows - 1 ? 0.5 : 1.0) * (c == 0 || c == def.columns - 1 ? 0.5 : 1.0);
      const double cells = (def.rows - 1.0) * (def.columns - 1.0);
      const double particles = static_cast<double>(def.rows) * def.columns;
      model.mass.push_back(static_cast<Real>(
          def.mass_lumping == MassLumping::area ? total * share / cells : total / particles));
    }
  }
}

/// Two triangles a cell with alternating diagonals: a grid split along one diagonal is three times
/// too stiff against bending in one diagonal direction. Normals point along u x v.
template <class Real>
void split_cells(const ClothDef& def, ClothModel<Real>& model) {
  for (int r = 0; r + 1 < def.rows; ++r) {
    for (int c = 0; c + 1 < def.columns; ++c) {
      const Index a = r * def.columns + c, b = a + 1, d = a + def.columns, e = d + 1;
      if ((r + c) % 2 == 0) {
        model.triangles.push_back({a, b, e});
        model.triangles.push_back({a, e, d});
      } else {
        model.triangles.push_back({a, b, d});
        model.triangles.push_back({b, e, d});
      }
    }
  }
  const double area = 0.5 * def.width * def.height / ((def.rows - 1.0) * (def.columns - 1.0));
  model.triangle_area.assign(model.triangles.size(), static_cast<Real>(area));
}

/// Bending rigidity times weight of a hinge whose edge spans (du, dv) in the material. An edge
/// along v bends with curvature along u. The diagonals resist twist alone, so their weight is 2
/// h_u^2 h_v^2 / (h_u^2 + h_v^2)^2 and their rigidity the mean (PHYSICS.md section 2).
double hinge_rigidity(const FabricDef& fabric, double du, double dv) {
  constexpr double kAlongAxis = 1e-9;
  if (du < kAlongAxis) return fabric.bending_warp;
  if (dv < kAlongAxis) return fabric.bending_weft;
  const double d2 = du * du + dv * dv;
  return 0.5 * (fabric.bending_warp + fabric.bending_weft) * 2 * du * du * dv * dv / (d2 * d2);
}

template <class Real>
void connect_triangles(const ClothDef& def, ClothModel<Real>& model) {
  const std::vector<TriangleSide> sides = sorted_sides(model.triangles);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const TriangleSide& first = sides[s];
    model.edges.push_back({first.low, first.high});
    if (s + 1 == sides.size() || sides[s + 1].low != first.low || sides[s + 1].high != first.high)
      continue;
    const TriangleSide& second = sides[++s];
    const auto& material = model.material;
    const auto i = static_cast<std::size_t>(first.low), j = static_cast<std::size_t>(first.high);
    const double rigidity = hinge_rigidity(
        def.fabric,
        std::abs(static_cast<double>(material[j][0]) - static_cast<double>(material[i][0])),
        std::abs(static_cast<double>(material[j][1]) - static_cast<double>(material[i][1])));
    if (rigidity == 0) continue;
    const Triangle& t1 = model.triangles[static_cast<std::size_t>(first.triangle)];
    const Triangle& t2 = model.triangles[static_cast<std::size_t>(second.triangle)];
    const auto corner = static_cast<std::size_t>(first.corner);
    Hinge<Real> hinge;
    hinge.x[0] = t1[(corner + 1) % 3];
    hinge.x[1] = t1[(corner + 2) % 3];
    hinge.x[2] = t1[corner];
    hinge.x[3] = t2[static_cast<std::size_t>(second.corner)];
    const double length2 =
        (model.rest_positions[j] - model.rest_positions[i]).template cast<double>().squaredNorm();
    const double area =
        static_cast<double>(model.triangle_area[static_cast<std::size_t>(first.triangle)]) +
        static_cast<double>(model.triangle_area[static_cast<std::size_t>(second.triangle)]);
    hinge.stiffness = static_cast<Real>(rigidity * length2 / area);
    hinge.damping = static_cast<Real>(def.fabric.bending_damping) * hinge.stiffness;
    hinge.rest_angle = static_cast<Real>(def.rest_angle);
    hinge.smallest_normal2 = static_cast<Real>(kCrumpledArea * kCrumpledArea * area * area);
    model.hinges.push_back(hinge);
  }
}

/// The springs' numbers by kind, unless some of them follow no rule.
template <class Real>
void summarise_springs(const ClothDef& def, ClothModel<Real>& model) {
  if (def.direct_springs || def.skip_stiffness != 0) return;
  const double cell_u = def.width / (def.columns - 1), cell_v = def.height / (def.rows - 1);
  const GridStiffness k = grid_stiffness(def.fabric, cell_u, cell_v);
  GridSprings<Real> springs;
  springs.warp = static_cast<Real>(k.warp);
  springs.weft = static_cast<Real>(k.weft);
  springs.shear = static_cast<Real>(k.shear);
  springs.rest_warp = static_cast<Real>(cell_u);
  springs.rest_weft = static_cast<Real>(cell_v);
  springs.rest_shear = static_cast<Real>(std::hypot(cell_u, cell_v));
  if (model.membrane_omega2 > 0)
    springs.damping_per_stiffness =
        static_cast<Real>(model.membrane_damping_rate / model.membrane_omega2);
  model.grid_springs = springs;
}

/// Keeps the hinges or replaces them by the quadratic form.
template <class Real>
void choose_bending(const ClothDef& def, ClothModel<Real>& model) {
  const bool quadratic =
      def.bending_model == BendingModel::quadratic ||
      (def.bending_model == BendingModel::automatic && quadratic_bending_fits(def));
  if (!quadratic) return;
  const FabricDef& fabric = def.fabric;
  const double cell_u = def.width / (def.columns - 1), cell_v = def.height / (def.rows - 1);
  model.quadratic_bending = {
      static_cast<Real>(fabric.bending_warp * cell_v / (cell_u * cell_u * cell_u)),
      static_cast<Real>(fabric.bending_weft * cell_u / (cell_v * cell_v * cell_v)),
      static_cast<Real>((fabric.bending_warp + fabric.bending_weft) / (cell_u * cell_v))};
  model.hinges.clear();
  bound_quadratic_bending(model);
}

}  // namespace

void validate(const ClothDef& def) {
  visit_fields_of_cloth(
      def, [](const FieldInfo& info, const auto& value) { check_field("cloth.", info, value); });
  visit_fields_of_fabric(def.fabric, [](const FieldInfo& info, const auto& value) {
    check_field("fabric.", info, value);
  });
  if (def.u.norm() < 1e-9)
    throw DefinitionError("cloth.u", "0,0,0", "a direction", "give a vector that is not zero");
  if (def.v.norm() < 1e-9 || std::abs(def.u.normalized().dot(def.v.normalized())) > 1e-6)
    throw DefinitionError(
        "cloth.v",
        number_text(def.v[0]) + "," + number_text(def.v[1]) + "," + number_text(def.v[2]),
        "a direction at right angles to cloth.u", "the cells are rectangles");
  if (def.bending_model == BendingModel::quadratic && !quadratic_bending_fits(def))
    throw DefinitionError("cloth.bending_model", "quadratic", "hinges or automatic",
                          "a rest angle or bending damping needs hinges");
  if (!def.direct_springs) return;
  const DirectSprings& d = *def.direct_springs;
  check_field("cloth.direct_springs.", {"structural", 0, 1e6, "N/m", ""}, d.structural);
  check_field("cloth.direct_springs.", {"shear", 0, 1e6, "N/m", ""}, d.shear);
  check_field("cloth.direct_springs.", {"skip", 0, 1e6, "N/m", ""}, d.skip);
  check_field("cloth.direct_springs.", {"dashpot", 0, 1e3, "N s/m", ""}, d.dashpot);
}

template <class Real>
ClothModel<Real> build_cloth(const ClothDef& def) {
  validate(def);
  ClothModel<Real> model;
  model.rows = def.rows;
  model.columns = def.columns;
  model.cell_u = static_cast<Real>(def.width / (def.columns - 1));
  model.cell_v = static_cast<Real>(def.height / (def.rows - 1));
  model.fabric = def.fabric;
  place_particles(def, model);
  lump_masses(def, model);
  split_cells(def, model);
  model.springs = grid_springs<Real>(def, model.spring_kinds);
  connect_triangles(def, model);
  bound_frequencies(model);
  if (!def.direct_springs) add_spring_damping(model, def.fabric.damping_ratio);
  summarise_springs(def, model);
  choose_bending(def, model);
  return model;
}

template <class Real>
std::vector<Index> particles_in_disc(const ClothModel<Real>& model, Index centre, double radius) {
  const auto& middle = model.material[static_cast<std::size_t>(centre)];
  std::vector<Index> inside;
  for (Index i = 0; i < model.particle_count(); ++i) {
    const auto& m = model.material[static_cast<std::size_t>(i)];
    const double du = static_cast<double>(m[0] - middle[0]),
                 dv = static_cast<double>(m[1] - middle[1]);
    if (i == centre || du * du + dv * dv <= radius * radius) inside.push_back(i);
  }
  return inside;
}

template ClothModel<float> build_cloth<float>(const ClothDef&);
template ClothModel<double> build_cloth<double>(const ClothDef&);
template std::vector<Index> particles_in_disc(const ClothModel<float>&, Index, double);
template std::vector<Index> particles_in_disc(const ClothModel<double>&, Index, double);

}  // namespace weft
