#include "core/forces/grid_pass.h"

#include <algorithm>

#include "core/forces/grid_kernels.h"

namespace weft {

template <class Real>
const Real* GridPass<Real>::at_origin(const std::vector<Real>& array) const {
  return array.data() + 2 * view_.stride + kGridMargin;
}

template <class Real>
void GridPass<Real>::prepare(const ClothPart<Real>& part) {
  view_ = {};
  if (!part.grid_springs || part.hinges.count > 0) return;
  first_ = static_cast<std::size_t>(part.particles.first);
  view_.rows = part.rows;
  view_.columns = part.columns;
  view_.stride = part.columns + 2 * kGridMargin;
  view_.springs = *part.grid_springs;
  view_.bending = part.quadratic_bending;
  air_normal_ = static_cast<Real>(part.fabric.air_normal);
  air_tangential_ = static_cast<Real>(part.fabric.air_tangential);

  const auto size = static_cast<std::size_t>(view_.stride * (view_.rows + 4));
  for (Components* components : {&x_, &v_, &wind_}) {
    for (std::vector<Real>& array : *components) array.assign(size, Real(0));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    view_.x[k] = at_origin(x_[k]);
    view_.v[k] = at_origin(v_[k]);
    view_.wind[k] = at_origin(wind_[k]);
  }
  for (std::vector<Real>* table : {&cell_, &border_half_, &inner_, &odd_})
    table->assign(static_cast<std::size_t>(view_.stride), Real(0));
  for (int c = 0; c < view_.columns; ++c) {
    const auto k = static_cast<std::size_t>(c + kGridMargin);
    const bool border = c == 0 || c == view_.columns - 1;
    cell_[k] = c + 1 < view_.columns ? Real(1) : Real(0);
    border_half_[k] = border ? Real(0.5) : Real(1);
    inner_[k] = border ? Real(0) : Real(1);
    odd_[k] = static_cast<Real>(c % 2);
  }
  view_.cell = cell_.data() + kGridMargin;
  view_.border_half = border_half_.data() + kGridMargin;
  view_.inner = inner_.data() + kGridMargin;
  view_.odd = odd_.data() + kGridMargin;
  scratch_.assign(static_cast<std::size_t>(view_.stride * kGridScratchRows), Real(0));
  view_.scratch = scratch_.data() + kGridMargin;
}

template <class Real>
void GridPass<Real>::scatter(const Vec3Array<Real>& values, Components& components) const {
  const std::ptrdiff_t origin = 2 * view_.stride + kGridMargin;
  grid_take_apart(view_, (values.data() + first_)->data(),
                  {components[0].data() + origin, components[1].data() + origin,
                   components[2].data() + origin});
}

template <class Real>
void GridPass<Real>::load(const Vec3Array<Real>& x, const Vec3Array<Real>& v) {
  scatter(x, x_);
  scatter(v, v_);
}

template <class Real>
void GridPass<Real>::load_wind(const Vec3Array<Real>& wind) {
  scatter(wind, wind_);
}

template <class Real>
void GridPass<Real>::compute_internal_forces(Vec3Array<Real>& force) {
  grid_internal_forces(view_, force[first_].data());
}

template <class Real>
void GridPass<Real>::compute_air_forces(double density, Vec3Array<Real>& force) {
  const Real pressure = static_cast<Real>(0.5 * density) * air_normal_;
  grid_air_forces(view_, pressure, air_tangential_, force[first_].data());
}

template class GridPass<float>;
template class GridPass<double>;

}  // namespace weft
