#include <cmath>

#include "core/forces/bending.h"
#include "core/forces/hinge.h"
#include "core/forces/run_block.h"

namespace weft {
namespace {

/// Forces on the four corners of a block of hinges.
template <class Real>
struct HingeBlock {
  BlockValues<Real> corner[4];
};

template <class Real>
struct HingeReaders {
  BlockReader<Real> x[4], v[4];
};

/// The same formula as hinge_angle and hinge_moment, component by component and with selections in
/// place of branches, in a form that compilers vectorise.
template <class Real, Index kStride>
void hinge_block(const Hinge<Real>& h, const HingeReaders<Real>& in, Index count,
                 HingeBlock<Real>& out) {
  const auto& [p0, p1, p2, p3] = in.x;
  const auto& [v0, v1, v2, v3] = in.v;
  for (Index n = 0; n < count; ++n) {
    const Index m = n * kStride;
    const Real ex = p1.x[m] - p0.x[m], ey = p1.y[m] - p0.y[m], ez = p1.z[m] - p0.z[m];
    const Real ax = p2.x[m] - p0.x[m], ay = p2.y[m] - p0.y[m], az = p2.z[m] - p0.z[m];
    const Real bx = p3.x[m] - p0.x[m], by = p3.y[m] - p0.y[m], bz = p3.z[m] - p0.z[m];
    const Real n1x = ey * az - ez * ay, n1y = ez * ax - ex * az, n1z = ex * ay - ey * ax;
    const Real n2x = by * ez - bz * ey, n2y = bz * ex - bx * ez, n2z = bx * ey - by * ex;
    const Real l2 = ex * ex + ey * ey + ez * ez;
    const Real q1 = n1x * n1x + n1y * n1y + n1z * n1z, q2 = n2x * n2x + n2y * n2y + n2z * n2z;
    const Real least = q1 < q2 ? q1 : q2;
    const bool sound = least > 0 && l2 > 0;
    const Real safe_l2 = sound ? l2 : Real(1);
    const Real l = std::sqrt(safe_l2);
    const Real cx = n1y * n2z - n1z * n2y, cy = n1z * n2x - n1x * n2z, cz = n1x * n2y - n1y * n2x;
    const Real theta = angle_of((cx * ex + cy * ey + cz * ez) / l, n1x * n2x + n1y * n2y + n1z * n2z);
    const Real crumpled = least < h.smallest_normal2 ? least / h.smallest_normal2 : Real(1);
    const Real lever = sound ? l * crumpled : Real(0);
    const Real m1 = lever / (sound ? q1 : Real(1)), m2 = lever / (sound ? q2 : Real(1));
    const Real s1 = (ax * ex + ay * ey + az * ez) / safe_l2, s2 = (bx * ex + by * ey + bz * ez) / safe_l2;
    // Velocities of the corners along the normals, by the levers of the gradient.
    const Real w1x = s1 * v1.x[m] + (Real(1) - s1) * v0.x[m] - v2.x[m];
    const Real w1y = s1 * v1.y[m] + (Real(1) - s1) * v0.y[m] - v2.y[m];
    const Real w1z = s1 * v1.z[m] + (Real(1) - s1) * v0.z[m] - v2.z[m];
    const Real w2x = s2 * v1.x[m] + (Real(1) - s2) * v0.x[m] - v3.x[m];
    const Real w2y = s2 * v1.y[m] + (Real(1) - s2) * v0.y[m] - v3.y[m];
    const Real w2z = s2 * v1.z[m] + (Real(1) - s2) * v0.z[m] - v3.z[m];
    const Real rate = m1 * (n1x * w1x + n1y * w1y + n1z * w1z) + m2 * (n2x * w2x + n2y * w2y + n2z * w2z);
    const Real bend = sound ? theta - h.rest_angle : Real(0);
    const Real moment = -h.stiffness * bend - h.damping * rate;
    const Real f1x = n1x * (m1 * moment), f1y = n1y * (m1 * moment), f1z = n1z * (m1 * moment);
    const Real f2x = n2x * (m2 * moment), f2y = n2y * (m2 * moment), f2z = n2z * (m2 * moment);
    out.corner[0].x[n] = f1x * (Real(1) - s1) + f2x * (Real(1) - s2);
    out.corner[0].y[n] = f1y * (Real(1) - s1) + f2y * (Real(1) - s2);
    out.corner[0].z[n] = f1z * (Real(1) - s1) + f2z * (Real(1) - s2);
    out.corner[1].x[n] = f1x * s1 + f2x * s2;
    out.corner[1].y[n] = f1y * s1 + f2y * s2;
    out.corner[1].z[n] = f1z * s1 + f2z * s2;
    out.corner[2].x[n] = -f1x;
    out.corner[2].y[n] = -f1y;
    out.corner[2].z[n] = -f1z;
    out.corner[3].x[n] = -f2x;
    out.corner[3].y[n] = -f2y;
    out.corner[3].z[n] = -f2z;
  }
}

}  // namespace

template <class Real>
void add_hinge_forces(const ClothModel<Real>& model, const ParticleFields<Real>& x,
                      const ParticleFields<Real>& v, ParticleFields<Real>& force) {
  HingeBlock<Real> pull;
  for (const Run<4>& run : model.hinge_runs) {
    const Hinge<Real>& h = model.hinges[static_cast<std::size_t>(run.element)];
    for_each_block(run, [&](Index offset, Index count) {
      const auto reader = [&](const ParticleFields<Real>& fields, std::size_t corner) {
        return BlockReader<Real>(fields, run.first[corner] + offset);
      };
      const HingeReaders<Real> in{{reader(x, 0), reader(x, 1), reader(x, 2), reader(x, 3)},
                                  {reader(v, 0), reader(v, 1), reader(v, 2), reader(v, 3)}};
      if (run.stride == 1)
        hinge_block<Real, 1>(h, in, count, pull);
      else
        hinge_block<Real, 2>(h, in, count, pull);
      for (std::size_t c = 0; c < 4; ++c)
        add_block(pull.corner[c], count, run.first[c] + offset, run.stride, Real(1), force);
    });
  }
}

template void add_hinge_forces(const ClothModel<float>&, const ParticleFields<float>&,
                               const ParticleFields<float>&, ParticleFields<float>&);
template void add_hinge_forces(const ClothModel<double>&, const ParticleFields<double>&,
                               const ParticleFields<double>&, ParticleFields<double>&);

}  // namespace weft
