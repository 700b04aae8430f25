// Passes of the dashpots of quadratic bending by stabilised explicit stages.

#include "core/solver/bending_dashpots.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <span>

#include "core/cloth/bending_stencil.h"
#include "core/solver/constants.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Stages that are stable over some time.
template <class Real>
int stages_of(const ClothPart<Real>& part, double seconds) {
  constexpr double kMargin = (1 + kMostTurning) * (1 + kMostTurning);
  const double rate = kMargin * static_cast<double>(part.bending_time) * part.bounds.bending_omega2;
  // The root of s^2 + s - 2 = 2 D rho, rounded up to an odd number.
  const double root = (std::sqrt(9 + 8 * seconds * rate) - 1) / 2;
  if (!(root < kMostDashpotStages)) return kMostDashpotStages + 1;
  const int least = std::max(3, static_cast<int>(std::ceil(root)));
  return least + 1 - least % 2;
}

/// Of each edge of a part the third particle of a triangle beside it.
template <class Real>
std::map<Edge, Index> opposite_particles(const ClothModel<Real>& model,
                                         const ClothPart<Real>& part) {
  std::map<Edge, Index> opposite;
  for (Index t = part.triangles.first; t < part.triangles.end(); ++t) {
    const Triangle& corners = model.triangles[static_cast<std::size_t>(t)];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
      opposite[{low, high}] = corners[(k + 2) % 3];
    }
  }
  return opposite;
}

}  // namespace

template <class Real>
void BendingDashpots<Real>::prepare(const ClothModel<Real>& model) {
  parts_.clear();
  std::size_t most = 0;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const ClothPart<Real>& part = model.parts[p];
    if (part.bending_time == 0) continue;
    Part& list = parts_.emplace_back();
    list.number = p;
    this->list(model, part, list);
    most = std::max(most, list.particles.size());
  }
  const std::size_t particles = parts_.empty() ? 0 : model.mass.size();
  gradient_.assign(most, {});
  for (QuadArray<Real>* array : {&start_, &now_, &before_, &change_, &product_})
    array->assign(particles, {});
}

template <class Real>
int BendingDashpots<Real>::stages(const ClothModel<Real>& model, double seconds) const {
  assert(seconds > 0);
  int most = 0;
  for (const Part& part : parts_)
    most = std::max(most, stages_of(model.parts[part.number], seconds));
  return most;
}

template <class Real>
double BendingDashpots<Real>::updates(const ClothModel<Real>& model, double seconds) const {
  double most = 0;
  for (const Part& part : parts_) {
    const ClothPart<Real>& cloth = model.parts[part.number];
    const double weights =
        static_cast<double>(part.weights.size()) / static_cast<double>(cloth.particles.count);
    most = std::max(most, stages_of(cloth, seconds) * weights);
  }
  return most;
}

/// Lists the stencils of a part, each with two lines that span its plane.
template <class Real>
void BendingDashpots<Real>::list(const ClothModel<Real>& model, const ClothPart<Real>& part,
                                 Part& list) const {
  const std::map<Edge, Index> beside = opposite_particles(model, part);
  list.begin = {0};
  std::size_t count_of_mesh = 0;  // of each triangle three
  visit_damped_stencils(part, [&](double k, const Index* p, const double* weights, int count) {
    list.particles.insert(list.particles.end(), p, p + count);
    for (int n = 0; n < count; ++n) list.weights.push_back(static_cast<Real>(weights[n]));
    std::array<Index, 4> plane{};
    if (part.bends_by_links) {
      const Index t = part.triangles.first + part.curvatures.triangles[count_of_mesh++ / 3];
      const Triangle& corners = model.triangles[static_cast<std::size_t>(t)];
      plane = {corners[0], corners[1], corners[0], corners[2]};
    } else if (count == 3) {
      const Index aside = beside.at({std::min(p[0], p[1]), std::max(p[0], p[1])});
      plane = {p[0], p[2], p[1], aside};
    } else if (count == 4) {
      plane = {p[0], p[3], p[1], p[2]};
    }
    const std::size_t begin = list.begin.back();
    std::array<std::size_t, 4> places{};
    for (std::size_t n = 0; n < 4; ++n) {
      const auto first = list.particles.begin() + static_cast<std::ptrdiff_t>(begin);
      const auto found = std::find(first, list.particles.end(), plane[n]);
      places[n] = static_cast<std::size_t>(found - first);
      if (found != list.particles.end()) continue;
      list.particles.push_back(plane[n]);
      list.weights.push_back(0);
    }
    list.plane.push_back(places);
    list.begin.push_back(list.particles.size());
    list.viscosity.push_back(static_cast<Real>(k) * part.bending_time);
  });
}

/// Finds the gradients of all b. With N the normal of the lines e and f, its change is that of
/// e x f across itself, over the length of that. Crumpled cloth, whose normal turns faster than it
/// bends, is not damped.
template <class Real>
void BendingDashpots<Real>::aim(const Part& part, const Vec3Array<Real>& x) {
  for (std::size_t s = 0; s < part.viscosity.size(); ++s) {
    const std::size_t begin = part.begin[s], end = part.begin[s + 1];
    const auto at = [&](std::size_t n) -> const Vec3<Real>& {
      return x[static_cast<std::size_t>(part.particles[n])];
    };
    std::array<std::size_t, 4> p = part.plane[s];
    for (std::size_t& place : p) place += begin;
    const Vec3<Real> e = at(p[1]) - at(p[0]), f = at(p[3]) - at(p[2]);
    const Vec3<Real> across = e.cross(f);
    const Real area = across.norm();
    const Vec3<Real> normal = area > 0 ? (across / area).eval() : Vec3<Real>::Zero().eval();
    const Real root = std::sqrt(part.viscosity[s]);
    Vec3<Real> value = Vec3<Real>::Zero();
    Real weight = 0;
    for (std::size_t n = begin; n < end; ++n) {
      value += (at(n) - at(begin)) * part.weights[n];
      weight += std::abs(part.weights[n]);
      gradient_[n] = to_quad<Real>(normal * (part.weights[n] * root));
    }
    const Vec3<Real> tangential = value - normal * normal.dot(value);
    const Real turning = 2 * (e.norm() + f.norm()) * tangential.norm();
    if (!(turning <= static_cast<Real>(kMostTurning) * weight * area)) {
      std::fill_n(gradient_.begin() + static_cast<std::ptrdiff_t>(begin), end - begin,
                  Quad<Real>{});
      continue;
    }
    const Vec3<Real> aside = tangential * (area > 0 ? root / area : Real(0));
    const Quad<Real> by_e = to_quad<Real>(f.cross(aside)), by_f = to_quad<Real>(aside.cross(e));
    gradient_[p[0]] -= by_e;
    gradient_[p[1]] += by_e;
    gradient_[p[2]] -= by_f;
    gradient_[p[3]] += by_f;
  }
}

/// Adds K v to `product`.
template <class Real>
void BendingDashpots<Real>::multiply(const Part& part, const QuadArray<Real>& v,
                                     QuadArray<Real>& product) const {
  for (std::size_t s = 0; s < part.viscosity.size(); ++s) {
    const std::size_t begin = part.begin[s], end = part.begin[s + 1];
    const Quad<Real> first = v[static_cast<std::size_t>(part.particles[begin])];
    Quad<Real> rates;  // by components
    for (std::size_t n = begin + 1; n < end; ++n)
      rates.lanes +=
          gradient_[n].lanes * (v[static_cast<std::size_t>(part.particles[n])] - first).lanes;
    const Real rate = rates[0] + rates[1] + rates[2];
    for (std::size_t n = begin; n < end; ++n)
      product[static_cast<std::size_t>(part.particles[n])] += gradient_[n] * rate;
  }
}

/// Finds the impulses of the dashpots on all particles, into `now_`.
template <class Real>
void BendingDashpots<Real>::pass(const Part& part, const IndexRange& range, int stages,
                                 Real seconds, const ClothState<Real>& state) {
  assert(stages >= 3 && stages % 2 == 1);
  const auto first = static_cast<std::size_t>(range.first),
             end = static_cast<std::size_t>(range.end());
  const auto b = [](int j) { return j < 2 ? 1.0 / 3 : (j * j + j - 2.0) / (2.0 * j * (j + 1)); };
  const double w = 4.0 / (stages * stages + stages - 2.0);
  for (QuadArray<Real>* array : {&start_, &before_, &product_})
    std::fill(array->begin() + range.first, array->begin() + range.end(), Quad<Real>{});
  to_quads(std::span<const Vec3<Real>>(state.v).subspan(first, end - first),
           change_.data() + range.first);
  multiply(part, change_, start_);
  for (std::size_t i = first; i < end; ++i)
    now_[i] = start_[i] * (-seconds * static_cast<Real>(w / 3));
  for (int j = 2; j <= stages; ++j) {
    stop_point();
    for (std::size_t i = first; i < end; ++i) change_[i] = now_[i] * state.inverse_mass[i];
    multiply(part, change_, product_);
    const double mu = (2.0 * j - 1) / j * b(j) / b(j - 1), nu = -(j - 1.0) / j * b(j) / b(j - 2);
    const auto by_now = static_cast<Real>(mu), by_before = static_cast<Real>(nu),
               by_product = -seconds * static_cast<Real>(mu * w),
               by_start = -seconds * static_cast<Real>(mu * w * b(j - 1));
    for (std::size_t i = first; i < end; ++i) {
      before_[i] = now_[i] * by_now + before_[i] * by_before + product_[i] * by_product +
                   start_[i] * by_start;
      product_[i] = {};
    }
    std::swap(now_, before_);
  }
}

template <class Real>
void BendingDashpots<Real>::act(const ClothModel<Real>& model, double seconds,
                                ClothState<Real>& state, HeldForces<Real>* held, Profile& profile) {
  assert(seconds > 0 && (parts_.empty() || state.v.size() == now_.size()));
  const StageTimer timer(profile, Stage::bending, 0);
  for (const Part& part : parts_) {
    if (state.is_asleep(part.number)) continue;
    const ClothPart<Real>& cloth = model.parts[part.number];
    const int stages = stages_of(cloth, seconds);
    aim(part, state.x);
    pass(part, cloth.particles, stages, static_cast<Real>(seconds), state);
    for (Index i = cloth.particles.first; i < cloth.particles.end(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Vec3<Real> impulse = to_vector(now_[k]);
      state.v[k] += impulse * state.inverse_mass[k];
      if (held && held->holds(i)) held->push(i, impulse.template cast<double>());
    }
    profile[Stage::bending].work += static_cast<std::size_t>(stages) * part.viscosity.size();
  }
}

template class BendingDashpots<float>;
template class BendingDashpots<double>;

}  // namespace weft
