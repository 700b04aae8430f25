// Passes of the dashpots of quadratic bending by stabilised explicit stages.

#include "core/solver/bending_dashpots.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "core/cloth/bending_stencil.h"
#include "core/solver/constants.h"

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

/// Calls work(band) for the bands of a part: the whole one without an executor.
template <class Part, class Work>
void for_bands(const Part& part, Executor* executor, Work&& work) {
  if (!executor || part.bands.empty())
    run_chunks(nullptr, 1, [&](int) { work(part.whole); });
  else
    run_chunks(executor, static_cast<int>(part.bands.size()),
               [&](int band) { work(part.bands[static_cast<std::size_t>(band)]); });
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
    divide(part.particles, list);
    most = std::max(most, list.particles.size());
  }
  const std::size_t particles = parts_.empty() ? 0 : model.mass.size();
  gradient_.assign(most, {});
  for (QuadArray<Real>* array : {&start_, &now_, &before_, &change_, &next_change_, &product_})
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

/// Divides particles into bands, unless most stencils would lie on borders: a mesh numbers its
/// particles as it likes.
template <class Real>
void BendingDashpots<Real>::divide(const IndexRange& particles, Part& part) const {
  const auto first = static_cast<std::size_t>(particles.first),
             count = static_cast<std::size_t>(particles.count), stencils = part.viscosity.size();
  part.whole = {first, first + count, 0, stencils, {{0, stencils, true}}};
  const std::size_t bands = std::min(count / kDashpotBandParticles, kMostDashpotBands);
  std::size_t touched = 0;
  for (std::size_t k = 0; k < bands && bands > 1; ++k) {
    Band band{first + count * k / bands,
              first + count * (k + 1) / bands,
              stencils * k / bands,
              stencils * (k + 1) / bands,
              {}};
    for (std::size_t s = 0; s < stencils; ++s) {
      std::size_t own = 0;
      for (std::size_t n = part.begin[s]; n < part.begin[s + 1]; ++n)
        own += band.has(part.particles[n]);
      if (own == 0) continue;
      const bool inside = own == part.begin[s + 1] - part.begin[s];
      if (band.runs.empty() || band.runs.back().end != s || band.runs.back().inside != inside)
        band.runs.push_back({s, s, inside});
      band.runs.back().end = s + 1;
      ++touched;
    }
    part.bands.push_back(std::move(band));
  }
  if (static_cast<double>(touched) > kMostTouched * static_cast<double>(stencils))
    part.bands.clear();
}

/// Finds the gradients of all b of a band's share. With N the normal of the lines e and f, its
/// change is that of e x f across itself, over the length of that. Crumpled cloth, whose normal
/// turns faster than it bends, is not damped.
template <class Real>
void BendingDashpots<Real>::aim(const Part& part, const Band& band, const Vec3Array<Real>& x) {
  for (std::size_t s = band.first_stencil; s < band.end_stencil; ++s) {
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

/// Rate of change of a stencil's b sqrt(tau k).
template <class Real>
inline Real BendingDashpots<Real>::rate_of(const Part& part, std::size_t s,
                                           const QuadArray<Real>& v) const {
  const std::size_t begin = part.begin[s], end = part.begin[s + 1];
  const Quad<Real> first = v[static_cast<std::size_t>(part.particles[begin])];
  Quad<Real> rates;  // by components
  for (std::size_t n = begin + 1; n < end; ++n)
    rates.lanes +=
        gradient_[n].lanes * (v[static_cast<std::size_t>(part.particles[n])] - first).lanes;
  return rates[0] + rates[1] + rates[2];
}

/// Adds K v to `product` at the band's particles.
template <class Real>
void BendingDashpots<Real>::multiply(const Part& part, const Band& band, const QuadArray<Real>& v,
                                     QuadArray<Real>& product) const {
  for (const Run& run : band.runs) {
    for (std::size_t s = run.first; s < run.end; ++s) {
      const Real rate = rate_of(part, s, v);
      for (std::size_t n = part.begin[s]; n < part.begin[s + 1]; ++n) {
        const Index i = part.particles[n];
        if (run.inside || band.has(i)) product[static_cast<std::size_t>(i)] += gradient_[n] * rate;
      }
    }
  }
}

/// Takes over velocities.
template <class Real>
void BendingDashpots<Real>::begin(const Band& band, const Vec3Array<Real>& v) {
  for (QuadArray<Real>* array : {&start_, &before_, &product_})
    std::fill(array->data() + band.first, array->data() + band.end, Quad<Real>{});
  to_quads(std::span<const Vec3<Real>>(v).subspan(band.first, band.end - band.first),
           change_.data() + band.first);
}

/// The first stage.
template <class Real>
void BendingDashpots<Real>::open(const Part& part, const Band& band, Real by_start,
                                 const std::vector<Real>& inverse_mass) {
  multiply(part, band, change_, start_);
  for (std::size_t i = band.first; i < band.end; ++i) {
    now_[i] = start_[i] * by_start;
    next_change_[i] = now_[i] * inverse_mass[i];
  }
}

/// A later stage, into `before_`. Other bands read `change_` meanwhile.
template <class Real>
void BendingDashpots<Real>::advance(const Part& part, const Band& band, const Factors& by,
                                    const std::vector<Real>& inverse_mass) {
  multiply(part, band, change_, product_);
  for (std::size_t i = band.first; i < band.end; ++i) {
    before_[i] =
        now_[i] * by.now + before_[i] * by.before + product_[i] * by.product + start_[i] * by.start;
    product_[i] = {};
    next_change_[i] = before_[i] * inverse_mass[i];
  }
}

/// Finds the impulses of the dashpots on all particles, into `now_`, and changes the velocities.
template <class Real>
void BendingDashpots<Real>::pass(const Part& part, int stages, Real seconds, Executor* executor,
                                 ClothState<Real>& state) {
  assert(stages >= 3 && stages % 2 == 1);
  const auto b = [](int j) { return j < 2 ? 1.0 / 3 : (j * j + j - 2.0) / (2.0 * j * (j + 1)); };
  const double w = 4.0 / (stages * stages + stages - 2.0);
  for_bands(part, executor, [&](const Band& band) { begin(band, state.v); });
  const Real by_start = -seconds * static_cast<Real>(w / 3);
  for_bands(part, executor,
            [&](const Band& band) { open(part, band, by_start, state.inverse_mass); });
  std::swap(change_, next_change_);
  for (int j = 2; j <= stages; ++j) {
    const double mu = (2.0 * j - 1) / j * b(j) / b(j - 1), nu = -(j - 1.0) / j * b(j) / b(j - 2);
    const Factors by{static_cast<Real>(mu), static_cast<Real>(nu),
                     -seconds * static_cast<Real>(mu * w),
                     -seconds * static_cast<Real>(mu * w * b(j - 1))};
    for_bands(part, executor,
              [&](const Band& band) { advance(part, band, by, state.inverse_mass); });
    std::swap(now_, before_);
    std::swap(change_, next_change_);
  }
  for_bands(part, executor, [&](const Band& band) {
    for (std::size_t i = band.first; i < band.end; ++i)
      state.v[i] += to_vector(now_[i]) * state.inverse_mass[i];
  });
}

template <class Real>
void BendingDashpots<Real>::act(const ClothModel<Real>& model, double seconds,
                                ClothState<Real>& state, HeldForces<Real>* held, Executor* executor,
                                Profile& profile) {
  assert(seconds > 0 && (parts_.empty() || state.v.size() == now_.size()));
  const StageTimer timer(profile, Stage::bending, 0);
  for (const Part& part : parts_) {
    if (state.is_asleep(part.number)) continue;
    const ClothPart<Real>& cloth = model.parts[part.number];
    const int stages = stages_of(cloth, seconds);
    for_bands(part, executor, [&](const Band& band) { aim(part, band, state.x); });
    pass(part, stages, static_cast<Real>(seconds), executor, state);
    for (Index i = cloth.particles.first; held && i < cloth.particles.end(); ++i) {
      const Vec3<Real> impulse = to_vector(now_[static_cast<std::size_t>(i)]);
      if (held->holds(i)) held->push(i, impulse.template cast<double>());
    }
    profile[Stage::bending].work += static_cast<std::size_t>(stages) * part.viscosity.size();
  }
}

template class BendingDashpots<float>;
template class BendingDashpots<double>;

}  // namespace weft
