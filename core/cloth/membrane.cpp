// Builds membrane triangles and bounds their frequency.

#include "core/cloth/membrane.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/cloth/constants.h"
#include "core/cloth/membrane_gradient.h"
#include "core/cloth/stability_bound.h"
#include "core/error.h"

namespace weft {

double membrane_coupling(const FabricDef& fabric) {
  return fabric.poisson == kPoissonOfGrid ? fabric.shear : fabric.poisson * fabric.stretch_weft;
}

namespace {

/// A number of five digits below another one.
double just_below(double value) {
  return std::stod(rounded_text(value * (1 - 1e-4), 5));
}

}  // namespace

void refuse_indefinite_membrane(const FabricDef& fabric) {
  const double coupling = membrane_coupling(fabric);
  const double product = fabric.stretch_warp * fabric.stretch_weft;
  if (coupling == 0 || coupling * coupling < product) return;
  if (fabric.poisson == kPoissonOfGrid)
    throw DefinitionError("fabric.shear", number_text(fabric.shear),
                          "below " + rounded_text(std::sqrt(product), 9) + " N/m without a poisson",
                          "without a Poisson's ratio the shear stiffness also couples the threads; "
                          "give fabric.poisson")
        .with(Range{0, just_below(std::sqrt(product))},
              fabric.stretch_warp < fabric.stretch_weft
                  ? std::vector<std::string>{"poisson", "stretch_warp", "stretch_weft"}
                  : std::vector<std::string>{"poisson", "stretch_weft", "stretch_warp"});
  const double most =
      fabric.stretch_weft > 0 ? std::sqrt(fabric.stretch_warp / fabric.stretch_weft) : 0;
  throw DefinitionError(
      "fabric.poisson", number_text(fabric.poisson),
      "less than " + rounded_text(most) + ", the root of stretch_warp / stretch_weft",
      "a fabric with this ratio would stretch by itself")
      .with(Range{0, just_below(most)}, {"stretch_weft", "stretch_warp"});
}

RestCorners laid_flat(const std::array<Vec3d, 3>& x, const RestCorners& material) {
  const Vec3d d1 = x[1] - x[0], d2 = x[2] - x[0];
  const double length = d1.norm();
  assert(length > 0);
  const Vec3d along = d1 / length;
  double p = d2.dot(along), q = d1.cross(d2).norm() / length;
  const auto m = [&](std::size_t k, std::size_t axis) {
    return material[k][axis] - material[0][axis];
  };
  // Mirrored coordinates take the triangle's other face.
  if (m(1, 0) * m(2, 1) - m(2, 0) * m(1, 1) < 0) q = -q;
  // (u, v) as a linear function of the flat triangle: its columns are their changes along both.
  const double u1 = m(1, 0) / length, v1 = m(1, 1) / length;
  const double u2 = (m(2, 0) - p * u1) / q, v2 = (m(2, 1) - p * v1) / q;
  double cosine = u1 + v2, sine = v1 - u2;
  const double size = std::sqrt(cosine * cosine + sine * sine);
  cosine = size > 0 ? cosine / size : 1;
  sine = size > 0 ? sine / size : 0;
  return {
      {{0, 0}, {length * cosine, length * sine}, {p * cosine - q * sine, p * sine + q * cosine}}};
}

template <class Real>
MembraneTriangle<Real> membrane_triangle(const Triangle& particles, const RestCorners& corners) {
  const double a0 = corners[1][0] - corners[0][0], a1 = corners[1][1] - corners[0][1];
  const double b0 = corners[2][0] - corners[0][0], b1 = corners[2][1] - corners[0][1];
  const double doubled = a0 * b1 - b0 * a1;
  assert(doubled != 0);
  MembraneTriangle<Real> t;
  t.x = particles;
  t.u1 = static_cast<Real>(b1 / doubled);
  t.u2 = static_cast<Real>(-a1 / doubled);
  t.v1 = static_cast<Real>(-b0 / doubled);
  t.v2 = static_cast<Real>(a0 / doubled);
  t.area = static_cast<Real>(0.5 * std::abs(doubled));
  return t;
}

namespace {

/// Sums over the corners of products of gradients over the corner's share of mass.
struct Mobility {
  double uu = 0, vv = 0, uv = 0;
};

/// The tensor as R R^T, with R lower triangular.
struct TensorRoot {
  double r11 = 0, r21 = 0, r22 = 0, shear = 0;

  template <class Real>
  explicit TensorRoot(const MembraneTensor<Real>& c) : shear(static_cast<double>(c.shear)) {
    r11 = std::sqrt(static_cast<double>(c.warp));
    r21 = r11 > 0 ? static_cast<double>(c.coupling) / r11 : 0;
    r22 = std::sqrt(std::max(0.0, static_cast<double>(c.weft) - r21 * r21));
  }
};

/// The largest root of x^3 - c2 x^2 + c1 x - c0, whose roots are real and not negative: Newton's
/// method starts from their sum and approaches it from above, so that every iterate is a bound.
double largest_root(double c2, double c1, double c0) {
  double x = c2;
  for (int round = 0; round < 60; ++round) {
    const double slope = (3 * x - 2 * c2) * x + c1;
    const double value = ((x - c2) * x + c1) * x - c0;
    if (!(slope > 0) || !(value > 0) || !(value > 1e-13 * x * slope)) break;
    x -= value / slope;
  }
  return x;
}

/// Squared frequency of a triangle at rest, over its area [1/(s^2 m^2)]: the largest eigenvalue of
/// R^T B M^-1 B^T R, with the derivatives B of the strains by the positions in the plane.
double at_rest(const TensorRoot& c, const Mobility& g) {
  const double s33 = g.uu + g.vv, root = std::sqrt(c.shear);
  const double a11 = c.r11 * c.r11 * g.uu + c.r21 * c.r21 * g.vv, a12 = c.r21 * c.r22 * g.vv,
               a22 = c.r22 * c.r22 * g.vv;
  const double a13 = (c.r11 + c.r21) * g.uv * root, a23 = c.r22 * g.uv * root, a33 = c.shear * s33;
  const double c2 = a11 + a22 + a33;
  const double c1 = a11 * a22 - a12 * a12 + a11 * a33 - a13 * a13 + a22 * a33 - a23 * a23;
  const double c0 =
      a11 * (a22 * a33 - a23 * a23) - a12 * (a12 * a33 - a23 * a13) + a13 * (a12 * a23 - a22 * a13);
  return largest_root(c2, std::max(0.0, c1), std::max(0.0, c0));
}

/// The same of both stretches alone, at the worst angle between the threads: parallel ones.
double crushed(const TensorRoot& c, const Mobility& g) {
  double most = 0;
  for (const double uv : {g.uv, -g.uv}) {
    const double a11 = c.r11 * c.r11 * g.uu + 2 * c.r11 * c.r21 * uv + c.r21 * c.r21 * g.vv;
    const double a12 = c.r11 * c.r22 * uv + c.r21 * c.r22 * g.vv, a22 = c.r22 * c.r22 * g.vv;
    const double mean = (a11 + a22) / 2, half = (a11 - a22) / 2;
    most = std::max(most, mean + std::sqrt(half * half + a12 * a12));
  }
  return most;
}

/// And of the shear alone, with threads of rest length at any angle: of its strain and of its
/// stress.
double sheared(const TensorRoot& c, const Mobility& g) {
  return c.shear * (g.uu + g.vv + 3 * std::abs(g.uv) + std::sqrt(g.uu * g.vv));
}

/// Shares of the particles' masses by triangle and corner.
template <class Real>
class MassShares {
 public:
  MassShares(const ClothModel<Real>& model, const ClothPart<Real>& part)
      : model_(model), part_(part), shares_(static_cast<std::size_t>(part.membrane.count)) {
    // First by how much each corner resists being moved; no corner is left without mass.
    const auto& c = part.membrane_tensor;
    const double base = static_cast<double>(c.shear) +
                        kLeastCornerWeight * static_cast<double>(c.warp + c.weft + c.shear);
    for (std::size_t n = 0; n < shares_.size(); ++n) {
      const CornerGradients<double> b = corner_gradients<double>(triangle(n));
      const auto area = static_cast<double>(triangle(n).area);
      for (std::size_t k = 0; k < 3; ++k)
        shares_[n][k] = area * ((base + static_cast<double>(c.warp)) * b.u[k] * b.u[k] +
                                (base + static_cast<double>(c.weft)) * b.v[k] * b.v[k]);
    }
    normalise();
  }

  std::size_t size() const { return shares_.size(); }

  const MembraneTriangle<Real>& triangle(std::size_t n) const {
    return model_.membrane[static_cast<std::size_t>(part_.membrane.first) + n];
  }

  Mobility mobility(std::size_t n) const {
    const CornerGradients<double> b = corner_gradients<double>(triangle(n));
    Mobility g;
    for (std::size_t k = 0; k < 3; ++k) {
      const double weight = static_cast<double>(triangle(n).area) / shares_[n][k];
      g.uu += b.u[k] * b.u[k] * weight;
      g.vv += b.v[k] * b.v[k] * weight;
      g.uv += b.u[k] * b.v[k] * weight;
    }
    return g;
  }

  /// Gives triangles with higher values more, at the cost of their neighbours.
  void favour(const std::vector<double>& values) {
    for (std::size_t n = 0; n < shares_.size(); ++n) {
      const double more = std::sqrt(values[n]);
      for (double& share : shares_[n]) share *= more;
    }
    normalise();
  }

 private:
  void normalise() {
    std::vector<double> sums(static_cast<std::size_t>(part_.particles.count), 0);
    const auto at = [&](std::size_t n, std::size_t k) {
      return static_cast<std::size_t>(triangle(n).x[k] - part_.particles.first);
    };
    for (std::size_t n = 0; n < shares_.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) sums[at(n, k)] += shares_[n][k];
    }
    for (std::size_t n = 0; n < shares_.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k)
        shares_[n][k] *=
            static_cast<double>(model_.mass[static_cast<std::size_t>(triangle(n).x[k])]) /
            sums[at(n, k)];
    }
  }

  const ClothModel<Real>& model_;
  const ClothPart<Real>& part_;
  std::vector<std::array<double, 3>> shares_;  // [kg]
};

}  // namespace

template <class Real>
void bound_membrane(const ClothModel<Real>& model, ClothPart<Real>& part) {
  part.bounds.membrane_omega2 = part.bounds.membrane_shear_omega2 = 0;
  part.bounds.membrane_damping_rate = 0;
  const TensorRoot c(part.membrane_tensor);
  if (part.membrane.count == 0 || (c.r11 == 0 && c.r22 == 0 && c.shear == 0)) return;
  MassShares<Real> shares(model, part);
  std::vector<double> values(shares.size());
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMassSharingRounds; ++round) {
    double most = 0, most_shear = 0;
    for (std::size_t n = 0; n < shares.size(); ++n) {
      const Mobility g = shares.mobility(n);
      const double shear = sheared(c, g);
      values[n] = std::max(kShakenMargin * at_rest(c, g), crushed(c, g) + shear);
      most = std::max(most, values[n]);
      most_shear = std::max(most_shear, shear);
    }
    if (most < best) {
      best = most;
      part.bounds.membrane_shear_omega2 = most_shear;
    }
    shares.favour(values);
  }
  part.bounds.membrane_omega2 = best;
  const double least = least_relaxation_time(part);
  const double stretch = std::max(part.fabric.stretch_damping, least),
               shear = std::max(part.fabric.shear_damping, least);
  part.membrane_tensor.stretch_time = static_cast<Real>(stretch);
  part.membrane_tensor.shear_time = static_cast<Real>(shear);
  part.bounds.membrane_damping_rate = std::max(stretch, shear) * best;
}

template <class Real>
double longest_thread(const ClothModel<Real>& model, const ClothPart<Real>& part,
                      const Vec3Array<Real>& x) {
  assert(x.size() == model.mass.size());
  Real most = 0;
  for (Index n = part.membrane.first; n < part.membrane.end(); ++n) {
    const MembraneTriangle<Real>& t = model.membrane[static_cast<std::size_t>(n)];
    const auto at = [&](std::size_t k) -> const Vec3<Real>& {
      return x[static_cast<std::size_t>(t.x[k])];
    };
    const Vec3<Real> d1 = at(1) - at(0), d2 = at(2) - at(0);
    most =
        std::max({most, gradient_u(t, d1, d2).squaredNorm(), gradient_v(t, d1, d2).squaredNorm()});
  }
  return std::sqrt(static_cast<double>(most));
}

double stretched_membrane_omega2(const FrequencyBounds& bounds, double longest_thread) {
  if (!(longest_thread > kFreeStretch)) return 0;
  return bounds.membrane_shear_omega2 * (longest_thread * longest_thread - 1);
}

#define WEFT_INSTANTIATE(Real)                                                                  \
  template MembraneTriangle<Real> membrane_triangle<Real>(const Triangle&, const RestCorners&); \
  template void bound_membrane(const ClothModel<Real>&, ClothPart<Real>&);                      \
  template double longest_thread(const ClothModel<Real>&, const ClothPart<Real>&,               \
                                 const Vec3Array<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
