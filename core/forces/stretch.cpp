#include "core/forces/stretch.h"

#include <cmath>

#include "core/forces/run_block.h"
#include "core/forces/spring.h"

namespace weft {
namespace {

/// Forces on the first ends of a block of like springs; component by component the same formula as
/// spring_force, in a form that compilers vectorise.
template <class Real, Index kStride>
void spring_block(const Spring<Real>& s, const BlockReader<Real>& xi, const BlockReader<Real>& xj,
                  const BlockReader<Real>& vi, const BlockReader<Real>& vj, Index count,
                  BlockValues<Real>& out) {
  const Real k = s.stiffness, c = s.damping, kl = s.stiffness * s.rest_length;
  for (Index n = 0; n < count; ++n) {
    const Index m = n * kStride;
    const Real dx = xj.x[m] - xi.x[m], dy = xj.y[m] - xi.y[m], dz = xj.z[m] - xi.z[m];
    const Real ux = vj.x[m] - vi.x[m], uy = vj.y[m] - vi.y[m], uz = vj.z[m] - vi.z[m];
    const Real l2 = dx * dx + dy * dy + dz * dz + Real(kSmallestSquaredLength);
    const Real per_l = Real(1) / std::sqrt(l2);
    const Real rate = (dx * ux + dy * uy + dz * uz) * (per_l * per_l);
    const Real f = k - kl * per_l + c * rate;
    out.x[n] = dx * f;
    out.y[n] = dy * f;
    out.z[n] = dz * f;
  }
}

}  // namespace

template <class Real>
void add_spring_forces(const ClothModel<Real>& model, const ParticleFields<Real>& x,
                       const ParticleFields<Real>& v, ParticleFields<Real>& force) {
  BlockValues<Real> pull;
  for (const Run<2>& run : model.spring_runs) {
    const Spring<Real>& s = model.springs[static_cast<std::size_t>(run.element)];
    for_each_block(run, [&](Index offset, Index count) {
      const Index i = run.first[0] + offset, j = run.first[1] + offset;
      const BlockReader<Real> xi(x, i), xj(x, j), vi(v, i), vj(v, j);
      if (run.stride == 1)
        spring_block<Real, 1>(s, xi, xj, vi, vj, count, pull);
      else
        spring_block<Real, 2>(s, xi, xj, vi, vj, count, pull);
      add_block(pull, count, i, run.stride, Real(1), force);
      add_block(pull, count, j, run.stride, Real(-1), force);
    });
  }
}

template <class Real>
void add_stretch_energy(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                        ElasticEnergy& energy) {
  for (std::size_t n = 0; n < model.springs.size(); ++n) {
    const Spring<Real>& s = model.springs[n];
    const Vec3<Real> d = x[static_cast<std::size_t>(s.j)] - x[static_cast<std::size_t>(s.i)];
    const auto stretch = static_cast<double>(std::sqrt(d.squaredNorm()) - s.rest_length);
    energy.stretch += 0.5 * static_cast<double>(s.stiffness) * stretch * stretch;
    if (model.spring_kinds[n] == SpringKind::skip) continue;
    const double strain = std::abs(stretch) / static_cast<double>(s.rest_length);
    if (!(strain <= energy.largest_strain)) energy.largest_strain = strain;
  }
}

template <class Real>
void collect_strains(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                     std::vector<Real>& strain) {
  strain.clear();
  for (std::size_t n = 0; n < model.springs.size(); ++n) {
    if (model.spring_kinds[n] == SpringKind::skip) continue;
    const Spring<Real>& s = model.springs[n];
    const Vec3<Real> d = x[static_cast<std::size_t>(s.j)] - x[static_cast<std::size_t>(s.i)];
    strain.push_back(std::abs(d.norm() - s.rest_length) / s.rest_length);
  }
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template void add_spring_forces(const ClothModel<Real>&, const ParticleFields<Real>&,       \
                                  const ParticleFields<Real>&, ParticleFields<Real>&);        \
  template void add_stretch_energy(const ClothModel<Real>&, const Vec3Array<Real>&,           \
                                   ElasticEnergy&);                                           \
  template void collect_strains(const ClothModel<Real>&, const Vec3Array<Real>&, std::vector<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
