#include "core/forces/bending.h"

#include <algorithm>

#include "core/forces/hinge.h"

namespace weft {
namespace {

/// Work on one component of all particles.
template <class Real>
struct GridComponent {
  int rows, columns;
  const Real* x;
  Real* force;

  const Real* row(int r) const { return x + static_cast<std::ptrdiff_t>(r) * columns; }
  Real* force_row(int r) const { return force + static_cast<std::ptrdiff_t>(r) * columns; }
};

/// Rows and columns on the border stand for half a cell's width.
template <class Real>
Real border_share(int index, int count) {
  return index == 0 || index == count - 1 ? Real(0.5) : Real(1);
}

constexpr int kBlock = 64;

/// Stencils 1 -2 1 along the rows.
template <class Real>
void bend_along_u(const GridComponent<Real>& g, Real k) {
  Real d[kBlock];
  for (int r = 0; r < g.rows; ++r) {
    const Real kr = k * border_share<Real>(r, g.rows);
    for (int c = 1; c + 1 < g.columns; c += kBlock) {
      const int count = std::min(kBlock, g.columns - 1 - c);
      const Real* x = g.row(r) + c;
      for (int n = 0; n < count; ++n) d[n] = kr * (x[n - 1] - Real(2) * x[n] + x[n + 1]);
      Real* f = g.force_row(r) + c;
      for (int n = 0; n < count; ++n) f[n - 1] -= d[n];
      for (int n = 0; n < count; ++n) f[n] += Real(2) * d[n];
      for (int n = 0; n < count; ++n) f[n + 1] -= d[n];
    }
  }
}

/// Stencils 1 -2 1 down the columns.
template <class Real>
void bend_along_v(const GridComponent<Real>& g, Real k) {
  Real d[kBlock];
  for (int r = 1; r + 1 < g.rows; ++r) {
    for (int c = 0; c < g.columns; c += kBlock) {
      const int count = std::min(kBlock, g.columns - c);
      const Real *above = g.row(r - 1) + c, *x = g.row(r) + c, *below = g.row(r + 1) + c;
      for (int n = 0; n < count; ++n) d[n] = k * (above[n] - Real(2) * x[n] + below[n]);
      if (c == 0) d[0] *= Real(0.5);
      if (c + count == g.columns) d[count - 1] *= Real(0.5);
      Real *f0 = g.force_row(r - 1) + c, *f1 = g.force_row(r) + c, *f2 = g.force_row(r + 1) + c;
      for (int n = 0; n < count; ++n) f0[n] -= d[n];
      for (int n = 0; n < count; ++n) f1[n] += Real(2) * d[n];
      for (int n = 0; n < count; ++n) f2[n] -= d[n];
    }
  }
}

/// Stencils of the four corners of each cell.
template <class Real>
void twist_cells(const GridComponent<Real>& g, Real k) {
  Real d[kBlock];
  for (int r = 0; r + 1 < g.rows; ++r) {
    for (int c = 0; c + 1 < g.columns; c += kBlock) {
      const int count = std::min(kBlock, g.columns - 1 - c);
      const Real *x = g.row(r) + c, *below = g.row(r + 1) + c;
      for (int n = 0; n < count; ++n) d[n] = k * ((x[n] - x[n + 1]) - (below[n] - below[n + 1]));
      Real *f0 = g.force_row(r) + c, *f1 = g.force_row(r + 1) + c;
      for (int n = 0; n < count; ++n) f0[n] -= d[n];
      for (int n = 0; n < count; ++n) f0[n + 1] += d[n];
      for (int n = 0; n < count; ++n) f1[n] += d[n];
      for (int n = 0; n < count; ++n) f1[n + 1] -= d[n];
    }
  }
}

/// k/2 |w x|^2 summed over all stencils.
template <class Real>
double quadratic_energy(const ClothModel<Real>& model, const Vec3Array<Real>& x) {
  const auto at = [&](int r, int c) {
    return x[static_cast<std::size_t>(r * model.columns + c)].template cast<double>().eval();
  };
  const QuadraticBending<Real>& q = model.quadratic_bending;
  const auto along_u = static_cast<double>(q.along_u), along_v = static_cast<double>(q.along_v);
  double sum = 0;
  for (int r = 0; r < model.rows; ++r) {
    for (int c = 0; c < model.columns; ++c) {
      if (c > 0 && c + 1 < model.columns)
        sum += along_u * border_share<double>(r, model.rows) *
               (at(r, c - 1) - 2 * at(r, c) + at(r, c + 1)).squaredNorm();
      if (r > 0 && r + 1 < model.rows)
        sum += along_v * border_share<double>(c, model.columns) *
               (at(r - 1, c) - 2 * at(r, c) + at(r + 1, c)).squaredNorm();
      if (r + 1 < model.rows && c + 1 < model.columns)
        sum += static_cast<double>(q.twist) *
               ((at(r, c) - at(r, c + 1)) - (at(r + 1, c) - at(r + 1, c + 1))).squaredNorm();
    }
  }
  return 0.5 * sum;
}

}  // namespace

template <class Real>
void add_quadratic_bending_forces(const ClothModel<Real>& model, const ParticleFields<Real>& x,
                                  ParticleFields<Real>& force) {
  const QuadraticBending<Real>& q = model.quadratic_bending;
  const GridComponent<Real> components[] = {
      {model.rows, model.columns, x.x.data(), force.x.data()},
      {model.rows, model.columns, x.y.data(), force.y.data()},
      {model.rows, model.columns, x.z.data(), force.z.data()}};
  for (const GridComponent<Real>& g : components) {
    bend_along_u(g, q.along_u);
    bend_along_v(g, q.along_v);
    twist_cells(g, q.twist);
  }
}

template <class Real>
std::size_t quadratic_stencil_count(const ClothModel<Real>& model) {
  const QuadraticBending<Real>& q = model.quadratic_bending;
  if (q.along_u == 0 && q.along_v == 0 && q.twist == 0) return 0;
  const auto rows = static_cast<std::size_t>(model.rows), columns = static_cast<std::size_t>(model.columns);
  return rows * (columns - 2) + (rows - 2) * columns + (rows - 1) * (columns - 1);
}

template <class Real>
void add_bending_energy(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                        ElasticEnergy& energy) {
  if (quadratic_stencil_count(model) > 0) energy.bending += quadratic_energy(model, x);
  for (const Hinge<Real>& h : model.hinges) {
    const auto at = [&](int corner) { return x[static_cast<std::size_t>(h.x[corner])]; };
    const HingeAngle<Real> angle = hinge_angle<Real>(at(0), at(1), at(2), at(3), h.smallest_normal2);
    energy.bending += static_cast<double>(hinge_energy(h, angle.theta));
  }
}

#define WEFT_INSTANTIATE(Real)                                                                      \
  template void add_quadratic_bending_forces(const ClothModel<Real>&, const ParticleFields<Real>&,  \
                                             ParticleFields<Real>&);                                \
  template std::size_t quadratic_stencil_count(const ClothModel<Real>&);                            \
  template void add_bending_energy(const ClothModel<Real>&, const Vec3Array<Real>&, ElasticEnergy&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
