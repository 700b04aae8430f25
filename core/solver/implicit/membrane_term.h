#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/forces/membrane.h"
#include "core/solver/implicit/constants.h"
#include "core/solver/implicit/linear_terms.h"
#include "core/types.h"

// Force and derivative of a membrane triangle.

namespace weft {

/// Forces of a triangle on its corners and minus their derivatives by the positions, without the
/// indefinite part. Between changes of the gradients w_u and w_v the matrix is
///   J^T C (1 + tau rate) J  +  S n n^T  +  diag(s_u p_u p_u^T, s_v p_v p_v^T),
/// with J the derivatives of the strains, S the tensile part of the stress (whose eigenvalues are
/// not negative), n the normal, and p_u = n x w_u / |w_u|. Exact in tension, except for the turn of
/// the threads towards each other and of the dashpot's stress; in compression the directions of the
/// threads are treated as constant, as are those of springs.
template <class Real>
class MembraneTerm {
 public:
  using Matrix = Eigen::Matrix<Real, 3, 3>;

  MembraneTerm() = default;

  /// @param x,v   of the corners
  /// @param rate  derivative of velocities by positions [1/s]
  MembraneTerm(const MembraneTensor<Real>& c, const MembraneTriangle<Real>& t,
               const std::array<Vec3<Real>, 3>& x, const std::array<Vec3<Real>, 3>& v, Real rate) {
    const MembraneStrain<Real> e = membrane_strain<Real>(t, x[1] - x[0], x[2] - x[0]);
    const Vec3<Real> v1 = v[1] - v[0], v2 = v[2] - v[0];
    forces_ = membrane_forces(
        t, membrane_stress<Real>(c, t, e, gradient_u(t, v1, v2), gradient_v(t, v1, v2)));
    const Real factor = t.area * (1 + c.stretch_time * rate),
               shear = t.area * (1 + c.shear_time * rate) * c.shear;
    const Vec3<Real> u = e.w_u * e.per_u, w = e.w_v * e.per_v;
    uu_ = u * u.transpose() * (factor * c.warp) + e.w_v * e.w_v.transpose() * shear;
    vv_ = w * w.transpose() * (factor * c.weft) + e.w_u * e.w_u.transpose() * shear;
    uv_ = u * w.transpose() * (factor * c.coupling) + e.w_v * e.w_u.transpose() * shear;
    add_tension(c, t, e, u, w);
  }

  const std::array<Vec3<Real>, 3>& forces() const { return forces_; }

  /// Minus the changes of the forces when the corners move by `p`.
  std::array<Vec3<Real>, 3> times(const MembraneTriangle<Real>& t,
                                  const std::array<Vec3<Real>, 3>& p) const {
    const Vec3<Real> d1 = p[1] - p[0], d2 = p[2] - p[0];
    const Vec3<Real> u = gradient_u(t, d1, d2), v = gradient_v(t, d1, d2);
    const Vec3<Real> along_u = uu_ * u + uv_ * v, along_v = uv_.transpose() * u + vv_ * v;
    const Vec3<Real> y1 = along_u * t.u1 + along_v * t.v1, y2 = along_u * t.u2 + along_v * t.v2;
    return {-(y1 + y2), y1, y2};
  }

  /// The matrix of a corner with itself.
  SymmetricBlock<Real> own(const MembraneTriangle<Real>& t, std::size_t corner) const {
    assert(corner < 3);
    const CornerGradients<Real> b = corner_gradients<Real>(t);
    const Real b_u = b.u[corner], b_v = b.v[corner];
    const Matrix a = uu_ * (b_u * b_u) + vv_ * (b_v * b_v) + (uv_ + uv_.transpose()) * (b_u * b_v);
    return {a(0, 0), a(0, 1), a(0, 2), a(1, 1), a(1, 2), a(2, 2)};
  }

  /// Rows of a corner, columns of another one.
  Matrix between(const MembraneTriangle<Real>& t, std::size_t corner, std::size_t other) const {
    assert(corner < 3 && other < 3);
    const CornerGradients<Real> b = corner_gradients<Real>(t);
    return uu_ * (b.u[corner] * b.u[other]) + vv_ * (b.v[corner] * b.v[other]) +
           uv_ * (b.u[corner] * b.v[other]) + uv_.transpose() * (b.v[corner] * b.u[other]);
  }

 private:
  void add_tension(const MembraneTensor<Real>& c, const MembraneTriangle<Real>& t,
                   const MembraneStrain<Real>& e, const Vec3<Real>& u, const Vec3<Real>& w) {
    const Vec3<Real> across = u.cross(w);
    const Real size = across.norm();
    if (!(size > Real(kLeastThreadSine))) return;  // parallel threads: no normal
    const Vec3<Real> n = across / size;
    const Real s_u = t.area * (c.warp * e.u + c.coupling * e.v) * e.per_u,
               s_v = t.area * (c.weft * e.v + c.coupling * e.u) * e.per_v,
               s_t = t.area * c.shear * e.shear;
    // The tensile part of [s_u s_t; s_t s_v]: the sum over its positive eigenvalues.
    const Real mean = (s_u + s_v) / 2, half = (s_u - s_v) / 2;
    const Real radius = std::sqrt(half * half + s_t * s_t);
    const Real more = std::max(Real(0), mean + radius), less = std::max(Real(0), mean - radius);
    const Real common = (more + less) / 2, spread = (more - less) / 2;
    const Real cosine = radius > 0 ? half / radius : 1, sine = radius > 0 ? s_t / radius : 0;
    const Matrix out = n * n.transpose();
    const Vec3<Real> beside_u = n.cross(u), beside_w = n.cross(w);
    uu_ +=
        out * (common + spread * cosine) + beside_u * beside_u.transpose() * std::max(Real(0), s_u);
    vv_ +=
        out * (common - spread * cosine) + beside_w * beside_w.transpose() * std::max(Real(0), s_v);
    uv_ += out * (spread * sine);
  }

  std::array<Vec3<Real>, 3> forces_;
  Matrix uu_ = Matrix::Zero(), vv_ = Matrix::Zero(), uv_ = Matrix::Zero();
};

}  // namespace weft
