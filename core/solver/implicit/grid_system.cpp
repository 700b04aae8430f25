#include "core/solver/implicit/grid_system.h"

namespace weft {

template <class Real>
bool GridSystem<Real>::fits(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  if (part.rows < 2 || part.columns < 2 || part.hinges.count > 0) return false;
  for (Index k = part.springs.first; k < part.springs.end(); ++k) {
    const SpringKind kind = model.spring_kinds[static_cast<std::size_t>(k)];
    if (kind == SpringKind::skip || kind == SpringKind::edge) return false;
  }
  return true;
}

template <class Real>
GridSystem<Real>::GridSystem(const ClothModel<Real>& model, const ClothPart<Real>& part)
    : particles_(part.particles), springs_(part.springs) {
  multigrid_.prepare(GridLayout(part.rows, part.columns));
  SpringGrid<Real>& grid = multigrid_.finest();
  grid.set_bending(part.quadratic_bending);
  for (GridVector<Real>* vector : {&x_, &bent_}) vector->assign(size(), Real(0));
  for (Index k = springs_.first; k < springs_.end(); ++k) {
    const Spring<Real>& spring = model.springs[static_cast<std::size_t>(k)];
    const Index i = spring.i - particles_.first, j = spring.j - particles_.first;
    const Index first = i < j ? i : j, second = i < j ? j : i;
    const Index r = first / part.columns, step = second - first;
    Index c = first % part.columns;
    GridSpring kind = kFalling;
    if (second / part.columns == r) {
      kind = kAlong;
    } else if (step == part.columns) {
      kind = kDown;
    } else if (step < part.columns) {
      kind = kRising;
      --c;
    }
    kinds_.push_back(kind);
    cells_.push_back(static_cast<std::size_t>(grid.layout.at(r, c)));
  }
}

template <class Real>
std::array<std::size_t, 3> GridSystem<Real>::places(Index particle) const {
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
void GridSystem<Real>::linearise(const ClothModel<Real>& model, const NewtonPoint<Real>& at,
                                 Vec3Array<Real>& force) {
  SpringGrid<Real>& grid = multigrid_.finest();
  for (std::size_t n = 0; n < kinds_.size(); ++n) {
    const Spring<Real>& spring = model.springs[static_cast<std::size_t>(springs_.first) + n];
    const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
    const SpringTerm<Real> term(spring, at.x[j] - at.x[i], at.v[j] - at.v[i], at.rate);
    force[i] += term.force;
    force[j] -= term.force;
    for (std::size_t e = 0; e < 6; ++e) grid.springs[kinds_[n]][e][cells_[n]] = term.block[e];
  }
  for (Index k = 0; k < particles_.count; ++k) {
    const std::size_t place = places(k)[0];
    const auto i = static_cast<std::size_t>(particles_.first + k);
    for (std::size_t e = 0; e < 6; ++e) grid.own[e][place] = at.own[i][e];
  }
  if (grid.bends()) {
    load(at.x, x_.data());
    multiply_bending(grid, x_.data(), bent_.data());
    for (Real& number : bent_) number = -number;
    add(bent_.data(), force);
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
