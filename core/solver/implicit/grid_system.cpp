// Connects a grid's linear systems to its multigrid.

#include "core/solver/implicit/grid_system.h"

#include <cassert>

namespace weft {

template <class Real>
bool GridSystem<Real>::fits(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  if (part.rows < 2 || part.columns < 2 || part.hinges.count > 0) return false;
  if (!part.cells.site_stiffening.empty()) return false;  // its rows have one factor each
  for (Index k = part.springs.first; k < part.springs.end(); ++k) {
    const SpringKind kind = model.spring_kinds[static_cast<std::size_t>(k)];
    if (kind == SpringKind::skip || kind == SpringKind::edge) return false;
  }
  return true;
}

template <class Real>
GridSystem<Real>::GridSystem(const ClothModel<Real>& model, const ClothPart<Real>& part)
    : springs_(GridLayout(part.rows, part.columns), model, part), particles_(part.particles) {
  assert(fits(model, part));
  multigrid_.prepare(GridLayout(part.rows, part.columns), part.quadratic_bending, part.cells);
  for (GridVector<Real>* vector : {&x_, &v_, &force_}) vector->assign(size(), Real(0));
}

template <class Real>
std::array<std::size_t, 3> GridSystem<Real>::places(Index particle) const {
  assert(particle >= 0 && particle < particles_.count);
  const GridLayout& layout = grid().layout;
  const std::ptrdiff_t at = layout.at(particle / layout.columns, particle % layout.columns);
  return {static_cast<std::size_t>(at), static_cast<std::size_t>(at + layout.plane),
          static_cast<std::size_t>(at + 2 * layout.plane)};
}

template <class Real>
void GridSystem<Real>::set_pinned(const std::vector<Real>& inverse_mass) {
  for (Index i = 0; i < particles_.count; ++i)
    multigrid_.finest().free[places(i)[0]] =
        inverse_mass[static_cast<std::size_t>(particles_.first + i)] > 0 ? Real(1) : Real(0);
}

template <class Real>
void GridSystem<Real>::linearise(const ClothModel<Real>&, const NewtonPoint<Real>& at,
                                 Vec3Array<Real>& force) {
  assert(at.rate > 0);
  assert(at.v.size() == at.x.size() && at.inertia.size() == at.x.size());
  assert(force.size() == at.x.size());
  SpringGrid<Real>& grid = multigrid_.finest();
  load(at.x, x_.data());
  load(at.v, v_.data());
  weft::linearise(springs_, at.rate, x_.data(), v_.data(), grid, force_.data());
  add(force_.data(), force);
  grid.has_air = at.air != nullptr;
  auto i = static_cast<std::size_t>(particles_.first);
  for (int r = 0; r < grid.layout.rows; ++r) {
    auto k = static_cast<std::size_t>(grid.layout.at(r, 0));
    for (int c = 0; c < grid.layout.columns; ++c, ++i, ++k) {
      grid.inertia[k] = at.inertia[i];
      for (std::size_t e = 0; grid.has_air && e < 6; ++e) grid.air[e][k] = (*at.air)[i][e];
    }
  }
  multigrid_.coarsen();
}

template <class Real>
void GridSystem<Real>::load(const Vec3Array<Real>& from, Real* to) const {
  const GridLayout& layout = grid().layout;
  auto i = static_cast<std::size_t>(particles_.first);
  for (int r = 0; r < layout.rows; ++r) {
    Real* const at = to + layout.at(r, 0);
    for (int c = 0; c < layout.columns; ++c, ++i) {
      for (int d = 0; d < 3; ++d) at[d * layout.plane + c] = from[i][d];
    }
  }
}

template <class Real>
void GridSystem<Real>::add(const Real* from, Vec3Array<Real>& to) const {
  const GridLayout& layout = grid().layout;
  auto i = static_cast<std::size_t>(particles_.first);
  for (int r = 0; r < layout.rows; ++r) {
    const Real* const at = from + layout.at(r, 0);
    for (int c = 0; c < layout.columns; ++c, ++i) {
      for (int d = 0; d < 3; ++d) to[i][d] += at[d * layout.plane + c];
    }
  }
}

template class GridSystem<float>;
template class GridSystem<double>;

}  // namespace weft
