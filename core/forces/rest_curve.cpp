// Forces and energy of rest curves.

#include "core/forces/rest_curve.h"

#include <cassert>

namespace weft {
namespace {

/// One triangle of a part's rest curves, where the cloth is now.
template <class Real>
class BentTriangle {
 public:
  BentTriangle(const ClothPart<Real>& part, std::size_t number, const Vec3Array<Real>& x)
      : curves_(part.rest_curves), first_(part.particles.first), number_(number), x_(x) {
    assert(number < curves_.triangles.size() && number + 1 < curves_.begin.size());
    e_ = at(corner(1)) - at(corner(0));
    f_ = at(corner(2)) - at(corner(0));
    const Vec3<Real> cross = e_.cross(f_);
    const Real doubled_area = cross.norm();
    is_crumpled_ = !(doubled_area > curves_.smallest_cross[number]);
    length_ = is_crumpled_ ? curves_.smallest_cross[number] : doubled_area;
    normal_ = cross / length_;
  }

  /// Of its corners, and of any particle of its curvatures.
  std::size_t corner(std::size_t k) const {
    return static_cast<std::size_t>(first_ + curves_.triangles[number_][k]);
  }
  std::size_t particle(std::size_t n) const {
    return static_cast<std::size_t>(first_ + curves_.particles[n]);
  }
  std::size_t begin() const { return curves_.begin[number_]; }
  std::size_t end() const { return curves_.begin[number_ + 1]; }

  const Vec3<Real>& normal() const { return normal_; }

  /// p of the energy -n . p [N m].
  Vec3<Real> bend() const {
    Vec3<Real> sum = Vec3<Real>::Zero();
    for (std::size_t n = begin(); n < end(); ++n)
      sum += (at(particle(n)) - at(corner(0))) * curves_.pulls[n];
    return sum;
  }

  void add_forces(Vec3Array<Real>& force) const {
    for (std::size_t n = begin(); n < end(); ++n) force[particle(n)] += normal_ * curves_.pulls[n];
    // With N = e x f the energy changes by -dN . p / length, without p's part along a unit normal.
    const Vec3<Real> p = bend();
    const Vec3<Real> turned = is_crumpled_ ? p : (p - normal_ * normal_.dot(p)).eval();
    const Vec3<Real> aside = turned / length_;
    const Vec3<Real> on_first = f_.cross(aside), on_second = aside.cross(e_);
    force[corner(1)] += on_first;
    force[corner(2)] += on_second;
    force[corner(0)] -= on_first + on_second;
  }

 private:
  const Vec3<Real>& at(std::size_t i) const { return x_[i]; }

  const RestCurves<Real>& curves_;
  Index first_;
  std::size_t number_;
  const Vec3Array<Real>& x_;
  Vec3<Real> e_, f_, normal_;
  Real length_ = 0;
  bool is_crumpled_ = false;
};

}  // namespace

template <class Real>
void add_rest_curve_forces(const ClothPart<Real>& part, const Vec3Array<Real>& x,
                           Vec3Array<Real>& force) {
  assert(force.size() == x.size());
  for (std::size_t t = 0; t < part.rest_curves.triangles.size(); ++t)
    BentTriangle<Real>(part, t, x).add_forces(force);
}

template <class Real>
double rest_curve_energy(const ClothPart<Real>& part, const Vec3Array<Real>& x) {
  double energy = part.rest_curves.energy;
  for (std::size_t t = 0; t < part.rest_curves.triangles.size(); ++t) {
    const BentTriangle<Real> bent(part, t, x);
    energy -= static_cast<double>(bent.normal().dot(bent.bend()));
  }
  return energy;
}

template void add_rest_curve_forces(const ClothPart<float>&, const Vec3Array<float>&,
                                    Vec3Array<float>&);
template void add_rest_curve_forces(const ClothPart<double>&, const Vec3Array<double>&,
                                    Vec3Array<double>&);
template double rest_curve_energy(const ClothPart<float>&, const Vec3Array<float>&);
template double rest_curve_energy(const ClothPart<double>&, const Vec3Array<double>&);

}  // namespace weft
