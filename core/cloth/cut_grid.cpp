#include "core/cloth/cut_grid.h"

#include <cmath>

#include "core/cloth/grid_cells.h"
#include "core/cloth/grid_cloth.h"
#include "core/cloth/grid_springs.h"
#include "core/solver/substep_rule.h"

namespace weft {
namespace {

/// Which cells are kept, and the particles at their corners.
struct Cut {
  int rows = 0, columns = 0;  // of the whole grid
  double cell_u = 0, cell_v = 0;
  std::vector<bool> cells;
  std::vector<Index> particles;  // by place in the whole grid; kNone where there is none

  bool has_cell(int r, int c) const {
    return r >= 0 && c >= 0 && r + 1 < rows && c + 1 < columns &&
           cells[static_cast<std::size_t>(r * (columns - 1) + c)];
  }
  int cells_around(int r, int c) const {
    return has_cell(r - 1, c - 1) + has_cell(r - 1, c) + has_cell(r, c - 1) + has_cell(r, c);
  }
  double triangle_area() const { return 0.5 * cell_u * cell_v; }
  Index particle(int r, int c) const {
    return particles[static_cast<std::size_t>(r * columns + c)];
  }
};

Cut cut_out(const ClothDef& def) {
  Cut cut;
  cut.rows = def.rows;
  cut.columns = def.columns;
  cut.cell_u = def.width / (def.columns - 1);
  cut.cell_v = def.height / (def.rows - 1);
  for (int r = 0; r + 1 < def.rows; ++r) {
    for (int c = 0; c + 1 < def.columns; ++c) {
      const double x = (2 * c + 1.0) / (def.columns - 1) - 1,
                   y = (2 * r + 1.0) / (def.rows - 1) - 1;
      cut.cells.push_back(x * x + y * y <= 1);
    }
  }
  Index count = 0;
  for (int r = 0; r < def.rows; ++r) {
    for (int c = 0; c < def.columns; ++c)
      cut.particles.push_back(cut.cells_around(r, c) > 0 ? count++ : kNone);
  }
  return cut;
}

template <class Real>
void place_particles(const ClothDef& def, const Cut& cut, ClothModel<Real>& model) {
  const Vec3d u = def.u.normalized(), v = def.v.normalized();
  const double quarter = 0.25 * def.fabric.areal_density * cut.cell_u * cut.cell_v;
  double whole = 0;
  for (int r = 0; r < cut.rows; ++r) {
    for (int c = 0; c < cut.columns; ++c) {
      if (cut.particle(r, c) == kNone) continue;
      const double s = cut.cell_u * c, t = cut.cell_v * r;
      model.rest_positions.push_back((def.origin + s * u + t * v).template cast<Real>());
      model.material.push_back({static_cast<Real>(s), static_cast<Real>(t)});
      const double mass = quarter * cut.cells_around(r, c);
      model.mass.push_back(static_cast<Real>(mass));
      whole += mass;
    }
  }
  if (def.mass_lumping == MassLumping::equal)
    model.mass.assign(model.mass.size(),
                      static_cast<Real>(whole / static_cast<double>(model.mass.size())));
}

/// Half an axis spring from each cell beside it, both diagonals from each cell.
template <class Real>
void add_springs(const ClothDef& def, const Cut& cut, ClothModel<Real>& model) {
  const GridStiffness k = grid_stiffness(def.fabric, cut.cell_u, cut.cell_v);
  const auto add = [&](Index i, Index j, double length, double stiffness, SpringKind kind) {
    if (stiffness == 0) return;
    Spring<Real> spring;
    spring.i = i;
    spring.j = j;
    spring.rest_length = static_cast<Real>(length);
    spring.stiffness = static_cast<Real>(stiffness);
    model.springs.push_back(spring);
    model.spring_kinds.push_back(kind);
  };
  const double diagonal = std::hypot(cut.cell_u, cut.cell_v);
  for (int r = 0; r < cut.rows; ++r) {
    for (int c = 0; c < cut.columns; ++c) {
      const Index i = cut.particle(r, c);
      if (i == kNone) continue;
      const bool above = cut.has_cell(r - 1, c), left = cut.has_cell(r, c - 1),
                 here = cut.has_cell(r, c);
      if (above || here)
        add(i, cut.particle(r, c + 1), cut.cell_u, 0.5 * (above + here) * k.warp, SpringKind::warp);
      if (left || here)
        add(i, cut.particle(r + 1, c), cut.cell_v, 0.5 * (left + here) * k.weft, SpringKind::weft);
      if (here) add(i, cut.particle(r + 1, c + 1), diagonal, k.shear, SpringKind::shear);
      if (left) add(i, cut.particle(r + 1, c - 1), diagonal, k.shear, SpringKind::shear);
    }
  }
}

}  // namespace

template <class Real>
ClothModel<Real> build_cut_grid(const ClothDef& def) {
  const Cut cut = cut_out(def);
  ClothModel<Real> model;
  model.parts.emplace_back();
  ClothPart<Real>& part = model.parts.front();
  part.longest_edge = std::hypot(cut.cell_u, cut.cell_v);
  place_particles(def, cut, model);
  split_cells(cut, 0, model);
  add_springs(def, cut, model);
  add_hinges(def, cut, model);
  complete_part(def, model);
  bound_frequencies(model, part);
  add_spring_damping(model, part, def.fabric.damping_ratio);
  return model;
}

template ClothModel<float> build_cut_grid<float>(const ClothDef&);
template ClothModel<double> build_cut_grid<double>(const ClothDef&);

}  // namespace weft
