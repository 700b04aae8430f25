// Bounds frequencies and derives stable substeps.

#include "core/cloth/stability_bound.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include "core/cloth/bending_stencil.h"
#include "core/cloth/corner_places.h"
#include "core/geometry/hinge_angle.h"

namespace weft {

double largest_stable_substep(const StabilityBound& bound) {
  assert(!(bound.omega2 < 0) && !(bound.damping_rate < 0));
  if (bound.omega2 <= 0)
    return bound.damping_rate > 0 ? 2 / bound.damping_rate
                                  : std::numeric_limits<double>::infinity();
  const double c = bound.damping_rate;
  // The root in the form without cancellation: 4 / (c + sqrt(c^2 + 4 omega^2)).
  return 4 / (c + std::sqrt(c * c + 4 * bound.omega2));
}

long substeps_for(const StabilityBound& bound, double tick_seconds, int fewest) {
  assert(tick_seconds > 0 && fewest >= 1);
  const double count = std::ceil(tick_seconds / largest_stable_substep(bound));
  if (!(count <= kMostSubsteps)) return kMostSubsteps + 1L;
  return std::max(static_cast<long>(count), static_cast<long>(fewest));
}

namespace {

/// The largest row of a matrix, by the particles' masses.
template <class Real>
double largest(const std::vector<double>& rows, const ClothModel<Real>& model) {
  assert(rows.size() == model.mass.size());
  double most = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    most = std::max(most, rows[i] / static_cast<double>(model.mass[i]));
  return most;
}

/// Absolute rows of the matrix that the links of a mesh are. Its diagonal is their sum.
template <class Real>
std::vector<double> rows_of_links(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  std::vector<double> own(model.mass.size(), 0), others = own;
  for (const BendingLink& link : part.bending_links) {
    for (const Index end : {link.i, link.j}) {
      const auto i = static_cast<std::size_t>(part.particles.first + end);
      own[i] += link.weight;
      others[i] += std::abs(link.weight);
    }
  }
  for (std::size_t i = 0; i < own.size(); ++i) others[i] += std::abs(own[i]);
  return others;
}

/// Adds what the rest curves add to the links' absolute rows, however the cloth is folded, unless
/// its triangles are crumpled: pulls times the turning of the normal, both ways, and the sum of
/// pulled distances times the second derivative of the normal.
template <class Real>
void add_rows_of_curves(const ClothModel<Real>& model, const ClothPart<Real>& part,
                        std::vector<double>& rows) {
  const RestCurves<Real>& curves = part.rest_curves;
  const auto number = [&](Index i) { return static_cast<std::size_t>(part.particles.first + i); };
  for (std::size_t t = 0; t < curves.triangles.size(); ++t) {
    const auto x = [&](Index i) -> Vec3d {
      return model.rest_positions[number(i)].template cast<double>();
    };
    const Triangle& corner = curves.triangles[t];
    const Vec3d e = x(corner[1]) - x(corner[0]), f = x(corner[2]) - x(corner[0]);
    // A corner turns the normal by 1 / its height.
    Vec3d turning(Vec3d(f - e).norm(), f.norm(), e.norm());
    turning /= e.cross(f).norm();
    double pulls = 0, most = 0;
    for (std::size_t n = curves.begin[t]; n < curves.begin[t + 1]; ++n) {
      const double pull = std::abs(static_cast<double>(curves.pulls[n]));
      pulls += pull;
      most += pull * (x(curves.particles[n]) - x(corner[0])).norm();
      rows[number(curves.particles[n])] += pull * turning.sum();
    }
    for (std::size_t k = 0; k < 3; ++k)
      rows[number(corner[k])] +=
          turning[static_cast<Eigen::Index>(k)] * (pulls + 2 * most * turning.sum());
  }
}

}  // namespace

template <class Real>
void bound_springs(const ClothModel<Real>& model, ClothPart<Real>& part) {
  assert(part.springs.end() <= static_cast<Index>(model.springs.size()));
  std::vector<double> stretch(model.mass.size(), 0), damping(model.mass.size(), 0);
  for (Index k = part.springs.first; k < part.springs.end(); ++k) {
    const Spring<Real>& s = model.springs[static_cast<std::size_t>(k)];
    for (const Index end : {s.i, s.j}) {
      stretch[static_cast<std::size_t>(end)] += 2 * static_cast<double>(s.stiffness);
      damping[static_cast<std::size_t>(end)] += 2 * static_cast<double>(s.damping);
    }
  }
  part.bounds.membrane_omega2 = kShakenMargin * largest(stretch, model);
  part.bounds.membrane_damping_rate = largest(damping, model);
}

template <class Real>
void bound_hinges(const ClothModel<Real>& model, ClothPart<Real>& part) {
  assert(part.hinges.end() <= static_cast<Index>(model.hinges.size()));
  std::vector<double> bend(model.mass.size(), 0), damping(model.mass.size(), 0);
  std::map<Edge, std::array<Vec3d, 4>> unrolled;
  if (part.rests_by_triangle) unrolled = unrolled_hinges(model, part);
  for (Index k = part.hinges.first; k < part.hinges.end(); ++k) {
    const Hinge<Real>& h = model.hinges[static_cast<std::size_t>(k)];
    const auto at = [&](int corner) -> Vec3d {
      if (part.rests_by_triangle) {
        const Edge ends = {std::min(h.x[0], h.x[1]), std::max(h.x[0], h.x[1])};
        const bool runs_back = corner < 2 && h.x[0] > h.x[1];
        return unrolled.at(ends)[static_cast<std::size_t>(runs_back ? 1 - corner : corner)];
      }
      return model.rest_positions[static_cast<std::size_t>(h.x[corner])].template cast<double>();
    };
    const HingeAngle<double> angle = hinge_angle<double>(at(0), at(1), at(2), at(3));
    double sum = 0;
    for (const Vec3d& g : angle.gradient) sum += g.norm();
    for (int corner = 0; corner < 4; ++corner) {
      const auto i = static_cast<std::size_t>(h.x[corner]);
      const double row = angle.gradient[static_cast<std::size_t>(corner)].norm() * sum;
      bend[i] += static_cast<double>(h.stiffness) * row;
      damping[i] += static_cast<double>(h.damping) * row;
    }
  }
  part.bounds.bending_omega2 = largest(bend, model);
  part.bounds.bending_damping_rate = largest(damping, model);
}

template <class Real>
void bound_quadratic_bending(const ClothModel<Real>& model, ClothPart<Real>& part) {
  assert(part.particles.end() <= model.particle_count());
  std::vector<double> rows(model.mass.size(), 0);
  if (!part.bending_links.empty()) {
    rows = rows_of_links(model, part);
    add_rows_of_curves(model, part, rows);
  } else {
    visit_bending_stencils(
        part, [&](double k, const Index* corners, const double* weights, int count) {
          double sum = 0;
          for (int n = 0; n < count; ++n) sum += std::abs(weights[n]);
          for (int n = 0; n < count; ++n)
            rows[static_cast<std::size_t>(corners[n])] += k * std::abs(weights[n]) * sum;
        });
  }
  part.bounds.bending_omega2 = largest(rows, model);
  part.bounds.bending_damping_rate = 0;  // its dashpots act between ticks
}

template void bound_quadratic_bending(const ClothModel<float>&, ClothPart<float>&);
template void bound_quadratic_bending(const ClothModel<double>&, ClothPart<double>&);

/// By Collatz and Wielandt: for whatever positive v the largest quotient (D v)_i / (m_i v_i) is a
/// bound, and it falls with each v <- M^-1 D v.
template <class Real>
void bound_damped_area(const ClothModel<Real>& model, ClothPart<Real>& part) {
  assert(part.particles.end() <= model.particle_count());
  std::vector<double> v(model.mass.size(), 1), next(model.mass.size());
  for (int round = 0; round < kDampedAreaRounds; ++round) {
    std::fill(next.begin(), next.end(), 0);
    for (Index t = part.triangles.first; t < part.triangles.end(); ++t) {
      const Triangle& corners = model.triangles[static_cast<std::size_t>(t)];
      double sum = 0;
      for (const Index i : corners) sum += v[static_cast<std::size_t>(i)];
      sum *= static_cast<double>(model.triangle_area[static_cast<std::size_t>(t)]) / 9;
      for (const Index i : corners) next[static_cast<std::size_t>(i)] += sum;
    }
    double largest = 0;
    for (Index k = part.particles.first; k < part.particles.end(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      next[i] /= static_cast<double>(model.mass[i]);
      largest = std::max(largest, next[i] / v[i]);
    }
    part.bounds.area_per_mass = largest;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = next[i] / largest;
  }
}

template void bound_damped_area(const ClothModel<float>&, ClothPart<float>&);
template void bound_damped_area(const ClothModel<double>&, ClothPart<double>&);

template <class Real>
double least_relaxation_time(const ClothPart<Real>& part) {
  if (part.bounds.membrane_omega2 <= 0) return 0;
  return 2 * part.fabric.damping_ratio / std::sqrt(part.bounds.membrane_omega2);
}

template double least_relaxation_time(const ClothPart<float>&);
template double least_relaxation_time(const ClothPart<double>&);

template <class Real>
void add_spring_damping(const SpringTimes& times, ClothModel<Real>& model, ClothPart<Real>& part) {
  assert(times.warp >= 0 && times.weft >= 0 && times.shear >= 0);
  assert(model.spring_kinds.size() == model.springs.size());
  for (Index k = part.springs.first; k < part.springs.end(); ++k) {
    Spring<Real>& spring = model.springs[static_cast<std::size_t>(k)];
    const SpringKind kind = model.spring_kinds[static_cast<std::size_t>(k)];
    const double time = kind == SpringKind::weft    ? times.weft
                        : kind == SpringKind::shear ? times.shear
                                                    : times.warp;
    spring.damping = static_cast<Real>(time * static_cast<double>(spring.stiffness));
  }
  part.bounds.membrane_damping_rate =
      std::max({times.warp, times.weft, times.shear}) * part.bounds.membrane_omega2;
}

template void bound_springs(const ClothModel<float>&, ClothPart<float>&);
template void bound_springs(const ClothModel<double>&, ClothPart<double>&);
template void bound_hinges(const ClothModel<float>&, ClothPart<float>&);
template void bound_hinges(const ClothModel<double>&, ClothPart<double>&);
template void add_spring_damping(const SpringTimes&, ClothModel<float>&, ClothPart<float>&);
template void add_spring_damping(const SpringTimes&, ClothModel<double>&, ClothPart<double>&);

}  // namespace weft
