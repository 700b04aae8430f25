#include "core/forces/air_pass.h"

#include <cmath>

#include "core/forces/run_block.h"

namespace weft {
namespace {

template <class Real>
struct TriangleReaders {
  BlockReader<Real> x[3], v[3], wind[3];
};

/// A third of the force on each of a block of triangles: the same formula as air_force, component by
/// component, in a form that compilers vectorise.
template <class Real, Index kStride>
void triangle_block(Real pressure, Real skin, const TriangleReaders<Real>& in, Index count,
                    BlockValues<Real>& out) {
  const auto& [a, b, c] = in.x;
  const auto& [va, vb, vc] = in.v;
  const auto& [wa, wb, wc] = in.wind;
  constexpr Real kThird = Real(1.0 / 3.0);
  for (Index n = 0; n < count; ++n) {
    const Index m = n * kStride;
    const Real px = b.x[m] - a.x[m], py = b.y[m] - a.y[m], pz = b.z[m] - a.z[m];
    const Real qx = c.x[m] - a.x[m], qy = c.y[m] - a.y[m], qz = c.z[m] - a.z[m];
    const Real nx = py * qz - pz * qy, ny = pz * qx - px * qz, nz = px * qy - py * qx;
    const Real ux = ((wa.x[m] - va.x[m]) + (wb.x[m] - vb.x[m]) + (wc.x[m] - vc.x[m])) * kThird;
    const Real uy = ((wa.y[m] - va.y[m]) + (wb.y[m] - vb.y[m]) + (wc.y[m] - vc.y[m])) * kThird;
    const Real uz = ((wa.z[m] - va.z[m]) + (wb.z[m] - vb.z[m]) + (wc.z[m] - vc.z[m])) * kThird;
    const Real length2 = nx * nx + ny * ny + nz * nz;
    const Real per_length = Real(1) / std::sqrt(length2 > 0 ? length2 : Real(1));
    const Real area = Real(0.5) * length2 * per_length;
    const Real un = (ux * nx + uy * ny + uz * nz) * per_length;
    const Real along_n = kThird * area * un * (pressure * std::abs(un) - skin) * per_length;
    const Real along_u = kThird * skin * area;
    out.x[n] = nx * along_n + ux * along_u;
    out.y[n] = ny * along_n + uy * along_u;
    out.z[n] = nz * along_n + uz * along_u;
  }
}

}  // namespace

template <class Real>
void add_air_forces(const ClothModel<Real>& model, const ParticleFields<Real>& wind, double density,
                    const ParticleFields<Real>& x, const ParticleFields<Real>& v,
                    ParticleFields<Real>& force) {
  const Real pressure = static_cast<Real>(0.5 * density * model.fabric.air_normal);
  const Real skin = static_cast<Real>(density > 0 ? model.fabric.air_tangential : 0);
  BlockValues<Real> push;
  for (const Run<3>& run : model.triangle_runs) {
    for_each_block(run, [&](Index offset, Index count) {
      const auto reader = [&](const ParticleFields<Real>& fields, std::size_t corner) {
        return BlockReader<Real>(fields, run.first[corner] + offset);
      };
      const TriangleReaders<Real> in{{reader(x, 0), reader(x, 1), reader(x, 2)},
                                     {reader(v, 0), reader(v, 1), reader(v, 2)},
                                     {reader(wind, 0), reader(wind, 1), reader(wind, 2)}};
      if (run.stride == 1)
        triangle_block<Real, 1>(pressure, skin, in, count, push);
      else
        triangle_block<Real, 2>(pressure, skin, in, count, push);
      for (const Index corner : run.first)
        add_block(push, count, corner + offset, run.stride, Real(1), force);
    });
  }
}

template void add_air_forces(const ClothModel<float>&, const ParticleFields<float>&, double,
                             const ParticleFields<float>&, const ParticleFields<float>&,
                             ParticleFields<float>&);
template void add_air_forces(const ClothModel<double>&, const ParticleFields<double>&, double,
                             const ParticleFields<double>&, const ParticleFields<double>&,
                             ParticleFields<double>&);

}  // namespace weft
