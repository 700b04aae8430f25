// Forces and energy of the misfit of a grid's cells, cell by cell.

#include "core/forces/cell_misfit.h"

#include <array>
#include <cassert>

namespace weft {
namespace {

/// Calls visit(corners) for each cell that springs of the fabric span: the particles at (r, c),
/// (r, c + 1), (r + 1, c) and (r + 1, c + 1).
template <class Real, class Visitor>
void visit_cells(const ClothPart<Real>& part, Visitor&& visit) {
  if (part.grid_springs->misfit == 0) return;
  const GridCells& cells = part.cells;
  for (int r = 0; r + 1 < cells.rows; ++r) {
    for (int c = 0; c + 1 < cells.columns; ++c) {
      if (!cells.has_cell(r, c)) continue;
      std::array<std::size_t, 4> corners;
      for (int k = 0; k < 4; ++k)
        corners[static_cast<std::size_t>(k)] =
            static_cast<std::size_t>(part.particles.first + cells.particle(r + k / 2, c + k % 2));
      visit(corners);
    }
  }
}

template <class Real>
Vec3<Real> twist_of(const std::array<std::size_t, 4>& at, const Vec3Array<Real>& x) {
  return (x[at[3]] - x[at[2]]) - (x[at[1]] - x[at[0]]);
}

}  // namespace

template <class Real>
void add_misfit_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                       Vec3Array<Real>& force) {
  assert(force.size() == x.size());
  if (!part.grid_springs) return;
  const MisfitLaw<Real> law(*part.grid_springs);
  visit_cells(part, [&](const std::array<std::size_t, 4>& at) {
    const Vec3<Real> twist = twist_of(at, x);
    const Vec3<Real> push = twist * misfit_softening(law, twist.squaredNorm());
    force[at[0]] += push;
    force[at[1]] -= push;
    force[at[2]] -= push;
    force[at[3]] += push;
  });
}

template <class Real>
double misfit_energy(const ClothPart<Real>& part, const Vec3Array<Real>& x) {
  if (!part.grid_springs) return 0;
  const MisfitLaw<Real> law(*part.grid_springs);
  double doubled = 0;
  visit_cells(part, [&](const std::array<std::size_t, 4>& at) {
    doubled += static_cast<double>(doubled_misfit_energy(law, twist_of(at, x).squaredNorm()));
  });
  return -0.5 * doubled;
}

template void add_misfit_forces(const ClothPart<float>&, const Vec3Array<float>&,
                                Vec3Array<float>&);
template void add_misfit_forces(const ClothPart<double>&, const Vec3Array<double>&,
                                Vec3Array<double>&);
template double misfit_energy(const ClothPart<float>&, const Vec3Array<float>&);
template double misfit_energy(const ClothPart<double>&, const Vec3Array<double>&);

}  // namespace weft
