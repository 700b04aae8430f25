// Sums the losses of dashpots element by element.

#include "core/diagnostics/dashpots.h"

#include <cassert>

#include "core/forces/constants.h"
#include "core/forces/membrane.h"
#include "core/geometry/hinge_angle.h"

namespace weft {
namespace {

template <class Array>
Vec3d at(const Array& values, Index i) {
  return values[static_cast<std::size_t>(i)].template cast<double>();
}

template <class Real>
double spring_loss(const Spring<Real>& s, const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                   const Vec3Array<double>& displacement) {
  const Vec3d d = at(x, s.j) - at(x, s.i);
  const double rate = d.dot(at(v, s.j) - at(v, s.i));
  const double longer = d.dot(at(displacement, s.j) - at(displacement, s.i));
  return static_cast<double>(s.damping) * rate * longer /
         (d.squaredNorm() + kSmallestSquaredLength);
}

/// Changes of a triangle's three strains with the velocities or displacements of its corners.
struct StrainChange {
  double u = 0, v = 0, shear = 0;
};

template <class Real, class Array>
StrainChange strain_change(const MembraneTriangle<Real>& t, const MembraneStrain<Real>& strain,
                           const Array& of) {
  const Vec3d one = at(of, t.x[1]) - at(of, t.x[0]), two = at(of, t.x[2]) - at(of, t.x[0]);
  const Vec3d u = one * static_cast<double>(t.u1) + two * static_cast<double>(t.u2);
  const Vec3d v = one * static_cast<double>(t.v1) + two * static_cast<double>(t.v2);
  const Vec3d w_u = strain.w_u.template cast<double>(), w_v = strain.w_v.template cast<double>();
  return {w_u.dot(u) * static_cast<double>(strain.per_u),
          w_v.dot(v) * static_cast<double>(strain.per_v), w_v.dot(u) + w_u.dot(v)};
}

template <class Real>
double triangle_loss(const MembraneTensor<Real>& tensor, const MembraneTriangle<Real>& t,
                     const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                     const Vec3Array<double>& displacement) {
  const auto corner = [&](std::size_t k) { return x[static_cast<std::size_t>(t.x[k])]; };
  const MembraneStrain<Real> strain =
      membrane_strain<Real>(t, corner(1) - corner(0), corner(2) - corner(0));
  const StrainChange rate = strain_change(t, strain, v);
  const StrainChange change = strain_change(t, strain, displacement);
  const auto warp = static_cast<double>(tensor.warp), weft = static_cast<double>(tensor.weft),
             coupling = static_cast<double>(tensor.coupling);
  const double stretches = (warp * rate.u + coupling * rate.v) * change.u +
                           (weft * rate.v + coupling * rate.u) * change.v;
  const double shears = static_cast<double>(tensor.shear) * rate.shear * change.shear;
  return static_cast<double>(t.area) * (static_cast<double>(tensor.stretch_time) * stretches +
                                        static_cast<double>(tensor.shear_time) * shears);
}

template <class Real>
double hinge_loss(const Hinge<Real>& h, const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                  const Vec3Array<double>& displacement) {
  if (h.damping == 0) return 0;
  const auto corner = [&](std::size_t k) { return x[static_cast<std::size_t>(h.x[k])]; };
  const HingeAngle<Real> angle =
      hinge_angle<Real>(corner(0), corner(1), corner(2), corner(3), h.smallest_normal2);
  double rate = 0, change = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3d gradient = angle.gradient[a].template cast<double>();
    rate += gradient.dot(at(v, h.x[a]));
    change += gradient.dot(at(displacement, h.x[a]));
  }
  return static_cast<double>(h.damping) * rate * change;
}

}  // namespace

template <class Real>
double dashpot_loss(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                    const Vec3Array<Real>& v, const Vec3Array<double>& displacement,
                    Dashpots which) {
  assert(x.size() == model.mass.size() && v.size() == x.size());
  assert(displacement.size() == x.size());
  double sum = 0;
  for (const Hinge<Real>& h : model.hinges) sum += hinge_loss(h, x, v, displacement);
  if (which == Dashpots::hinges) return sum;
  for (const Spring<Real>& s : model.springs) sum += spring_loss(s, x, v, displacement);
  for (const ClothPart<Real>& part : model.parts) {
    for (Index n = part.membrane.first; n < part.membrane.end(); ++n)
      sum += triangle_loss(part.membrane_tensor, model.membrane[static_cast<std::size_t>(n)], x, v,
                           displacement);
  }
  return sum;
}

template double dashpot_loss(const ClothModel<float>&, const Vec3Array<float>&,
                             const Vec3Array<float>&, const Vec3Array<double>&, Dashpots);
template double dashpot_loss(const ClothModel<double>&, const Vec3Array<double>&,
                             const Vec3Array<double>&, const Vec3Array<double>&, Dashpots);

}  // namespace weft
