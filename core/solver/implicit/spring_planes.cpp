// Lays out a grid's springs and dispatches to their kernels.

#include "core/solver/implicit/spring_planes.h"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/implicit/spring_planes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second include guard serves that.
#include "core/solver/implicit/spring_planes-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {

WEFT_EXPORT_KERNEL(linearise_grid);

template <class Real>
void linearise(SpringPlanes<Real>& springs, Real rate, const Real* x, const Real* v,
               SpringGrid<Real>& grid, Real* force) {
  WEFT_RUN(linearise_grid, Real)(springs, rate, x, v, grid, force);
}

template <class Real>
SpringPlanes<Real>::SpringPlanes(const GridLayout& layout, const ClothModel<Real>& model,
                                 const ClothPart<Real>& part) {
  for (auto* planes : {&stiffness, &damping, &rest_length}) {
    for (AlignedVector<Real>& plane : *planes)
      plane.assign(static_cast<std::size_t>(layout.plane), Real(0));
  }
  // Rows of vectors extend up to a vector beyond the last column.
  forces.assign(static_cast<std::size_t>(24 * layout.stride + kGridMargin), Real(0));
  for (Index n = part.springs.first; n < part.springs.end(); ++n) {
    const Spring<Real>& spring = model.springs[static_cast<std::size_t>(n)];
    const Index i = spring.i - part.particles.first, j = spring.j - part.particles.first;
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
    assert(r + 1 <= layout.rows && c >= 0 && c < layout.columns);
    const auto cell = static_cast<std::size_t>(layout.at(r, c));
    stiffness[kind][cell] = spring.stiffness;
    damping[kind][cell] = spring.damping;
    rest_length[kind][cell] = spring.rest_length;
  }
}

WEFT_INSTANTIATE_FUNCTIONS(linearise)
template struct SpringPlanes<float>;
template struct SpringPlanes<double>;

}  // namespace weft
#endif
