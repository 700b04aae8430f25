// Passes of the dashpots of quadratic bending by stabilised explicit stages.

#include "core/solver/bending_dashpots.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/solver/constants.h"

namespace weft {
namespace {

/// The largest rate of a part's dashpots, over their relaxation time [1/s^2].
template <class Real>
double rate_over_time(const ClothPart<Real>& part) {
  return (1 + kMostTurning) * (1 + kMostTurning) * part.bounds.bending_omega2;
}

/// Stages that are stable over some time.
template <class Real>
int stages_of(const ClothPart<Real>& part, double seconds) {
  const double rate = static_cast<double>(part.bending_time) * rate_over_time(part);
  // The root of s^2 + s - 2 = 2 D rho, rounded up to an odd number.
  const double root = (std::sqrt(9 + 8 * seconds * rate) - 1) / 2;
  if (!(root < kMostDashpotStages)) return kMostDashpotStages + 1;
  const int least = std::max(3, static_cast<int>(std::ceil(root)));
  return least + 1 - least % 2;
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

/// Calls visit(range) for the numbers of a band's particles.
template <class Part, class Band, class Visit>
void for_ranges(const Part& part, const Band& band, Visit&& visit) {
  if (band.first == band.end) return;
  if (!part.planar) return visit(NumberRange{part.at(band.first, 0), part.at(band.end, 0)});
  for (std::size_t k = 0; k < 3; ++k)
    visit(NumberRange{part.at(band.first, k), part.at(band.end - 1, k) + 1});
}

}  // namespace

template <class Real>
void BendingDashpots<Real>::prepare(const ClothModel<Real>& model) {
  parts_.clear();
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const ClothPart<Real>& part = model.parts[p];
    if (part.bending_time == 0) continue;
    Part& list = parts_.emplace_back();
    list.number = p;
    list.families = dashpot_families(model, part);
    for (const DashpotFamily<Real>& family : list.families)
      list.stencils += family.groups * family.curvatures;
    list.planar = !list.families.empty() && !list.families.front().of_triangles;
    list.whole.first = static_cast<std::size_t>(part.particles.first);
    list.whole.end = static_cast<std::size_t>(part.particles.end());
    divide(list);
  }
  const std::size_t numbers = parts_.empty() ? 0 : 4 * model.mass.size();
  for (AlignedVector<Real>* array :
       {&inverse_mass_, &start_, &now_, &before_, &change_, &next_change_, &product_})
    array->assign(numbers, 0);
}

template <class Real>
DashpotPasses BendingDashpots<Real>::passes(const ClothModel<Real>& model, double seconds) const {
  DashpotPasses most;
  for (const Part& part : parts_) {
    const DashpotPasses needed = dashpot_passes(model.parts[part.number], seconds);
    if (needed.count > most.count || (needed.count == most.count && !needed.even)) most = needed;
  }
  return most;
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
double BendingDashpots<Real>::longest_time(const ClothModel<Real>& model, std::size_t part,
                                           double seconds) const {
  assert(seconds > 0 && part < model.parts.size());
  constexpr double kStages = kMostDashpotStages - 1;  // odd
  static_assert(kMostDashpotStages % 2 == 0);
  return (kStages * kStages + kStages - 2) / (2 * seconds * rate_over_time(model.parts[part]));
}

template <class Real>
double BendingDashpots<Real>::updates(const ClothModel<Real>& model, double seconds) const {
  const DashpotPasses times = passes(model, seconds);
  const double longest = seconds * longest_share(times);
  double most = 0;
  for (const Part& part : parts_) {
    const ClothPart<Real>& cloth = model.parts[part.number];
    double numbers = 0;
    for (const DashpotFamily<Real>& family : part.families)
      numbers += static_cast<double>(family.batches * family.kLanes * family.slots);
    const double a_stage = kDashpotUpdates * numbers / static_cast<double>(cloth.particles.count);
    most = std::max(most, times.count * stages_of(cloth, longest) * a_stage);
  }
  return most;
}

/// Divides particles into bands, unless most batches would lie on borders: a mesh numbers its
/// particles as it likes.
template <class Real>
void BendingDashpots<Real>::divide(Part& part) const {
  const std::size_t first = part.whole.first, count = part.whole.end - first;
  std::size_t batches = 0, touched = 0;
  for (const DashpotFamily<Real>& family : part.families) {
    part.whole.shares.push_back({0, family.batches, true});
    part.whole.touching.push_back({{0, family.batches, true}});
    batches += family.batches;
  }
  const std::size_t bands = std::min(count / kDashpotBandParticles, kMostDashpotBands);
  for (std::size_t k = 0; k < bands && bands > 1; ++k) {
    Band band{first + count * k / bands, first + count * (k + 1) / bands, {}, {}};
    for (const DashpotFamily<Real>& family : part.families) {
      band.shares.push_back({family.batches * k / bands, family.batches * (k + 1) / bands, true});
      std::vector<DashpotRun>& runs = band.touching.emplace_back();
      const std::size_t places = family.slots * family.kLanes;
      for (std::size_t batch = 0; batch < family.batches; ++batch) {
        const auto place = family.places.begin() + static_cast<std::ptrdiff_t>(batch * places);
        const auto own = std::count_if(place, place + static_cast<std::ptrdiff_t>(places),
                                       [&](std::uint32_t at) {
                                         const std::size_t particle = family.particle(at);
                                         return particle >= band.first && particle < band.end;
                                       });
        if (own == 0) continue;
        const bool inside = own == static_cast<std::ptrdiff_t>(places);
        if (runs.empty() || runs.back().end != batch || runs.back().inside != inside)
          runs.push_back({batch, batch, inside});
        runs.back().end = batch + 1;
        ++touched;
      }
    }
    part.bands.push_back(std::move(band));
  }
  if (static_cast<double>(touched) > kMostTouched * static_cast<double>(batches))
    part.bands.clear();
}

/// Copies vectors into `change_`.
template <class Real>
void BendingDashpots<Real>::load(const Part& part, const Band& band, const Vec3Array<Real>& from) {
  for (std::size_t i = band.first; i < band.end; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      change_[part.at(i, k)] = from[i][static_cast<Eigen::Index>(k)];
  }
}

/// Finds the geometry of all stencils.
template <class Real>
void BendingDashpots<Real>::aim(Part& part, Executor* executor, const Vec3Array<Real>& x) {
  for_bands(part, executor, [&](const Band& band) { load(part, band, x); });
  for_bands(part, executor, [&](const Band& band) {
    for (std::size_t f = 0; f < part.families.size(); ++f)
      aim_dashpots(band.shares[f], change_.data(), part.families[f]);
  });
}

/// Takes over velocities and inverse masses.
template <class Real>
void BendingDashpots<Real>::begin(const Part& part, const Band& band,
                                  const ClothState<Real>& state) {
  load(part, band, state.v);
  for (std::size_t i = band.first; i < band.end; ++i) {
    for (std::size_t k = 0; k < 3; ++k) inverse_mass_[part.at(i, k)] = state.inverse_mass[i];
  }
  for_ranges(part, band, [&](const NumberRange& range) {
    for (AlignedVector<Real>* array : {&start_, &before_, &product_})
      std::fill(array->data() + range.first, array->data() + range.end, Real(0));
  });
}

/// Adds K times the present change to `product` at a band's particles.
template <class Real>
void BendingDashpots<Real>::multiply(Part& part, const Band& band, AlignedVector<Real>& product) {
  for (std::size_t f = 0; f < part.families.size(); ++f) {
    for (const DashpotRun& run : band.touching[f])
      multiply_dashpots(run, change_.data(), band.first, band.end, part.families[f],
                        product.data());
  }
}

template <class Real>
StageNumbers<Real> BendingDashpots<Real>::numbers() {
  return {inverse_mass_.data(), start_.data(),   now_.data(),
          before_.data(),       product_.data(), next_change_.data()};
}

/// The first stage.
template <class Real>
void BendingDashpots<Real>::open(Part& part, const Band& band, Real by_start) {
  multiply(part, band, start_);
  for_ranges(part, band,
             [&](const NumberRange& range) { open_dashpot_stages(range, by_start, numbers()); });
}

/// A later stage, into `before_`. Other bands read `change_` meanwhile.
template <class Real>
void BendingDashpots<Real>::advance(Part& part, const Band& band, const StageFactors<Real>& by) {
  multiply(part, band, product_);
  for_ranges(part, band,
             [&](const NumberRange& range) { advance_dashpot_stage(range, by, numbers()); });
}

template <class Real>
Vec3<Real> BendingDashpots<Real>::impulse_on(const Part& part, std::size_t particle) const {
  return {now_[part.at(particle, 0)], now_[part.at(particle, 1)], now_[part.at(particle, 2)]};
}

/// Finds the impulses of the dashpots on all particles, into `now_`, and changes the velocities.
template <class Real>
void BendingDashpots<Real>::pass(Part& part, int stages, Real seconds, Executor* executor,
                                 ClothState<Real>& state) {
  assert(stages >= 3 && stages % 2 == 1);
  const auto b = [](int j) { return j < 2 ? 1.0 / 3 : (j * j + j - 2.0) / (2.0 * j * (j + 1)); };
  const double w = 4.0 / (stages * stages + stages - 2.0);
  for_bands(part, executor, [&](const Band& band) { begin(part, band, state); });
  const Real by_start = -seconds * static_cast<Real>(w / 3);
  for_bands(part, executor, [&](const Band& band) { open(part, band, by_start); });
  std::swap(change_, next_change_);
  for (int j = 2; j <= stages; ++j) {
    const double mu = (2.0 * j - 1) / j * b(j) / b(j - 1), nu = -(j - 1.0) / j * b(j) / b(j - 2);
    const StageFactors<Real> by{static_cast<Real>(mu), static_cast<Real>(nu),
                                -seconds * static_cast<Real>(mu * w),
                                -seconds * static_cast<Real>(mu * w * b(j - 1))};
    for_bands(part, executor, [&](const Band& band) { advance(part, band, by); });
    std::swap(now_, before_);
    std::swap(change_, next_change_);
  }
  for_bands(part, executor, [&](const Band& band) {
    for (std::size_t i = band.first; i < band.end; ++i)
      state.v[i] += impulse_on(part, i) * state.inverse_mass[i];
  });
}

template <class Real>
void BendingDashpots<Real>::act(const ClothModel<Real>& model, double seconds,
                                ClothState<Real>& state, HeldForces<Real>* held, Executor* executor,
                                Profile& profile) {
  assert(seconds > 0 && (parts_.empty() || 4 * state.v.size() == now_.size()));
  const StageTimer timer(profile, Stage::bending, 0);
  for (Part& part : parts_) {
    if (state.is_asleep(part.number)) continue;
    const ClothPart<Real>& cloth = model.parts[part.number];
    const int stages = stages_of(cloth, seconds);
    aim(part, executor, state.x);
    pass(part, stages, static_cast<Real>(seconds), executor, state);
    for (Index i = cloth.particles.first; held && i < cloth.particles.end(); ++i) {
      const Vec3<Real> impulse = impulse_on(part, static_cast<std::size_t>(i));
      if (held->holds(i)) held->push(i, impulse.template cast<double>());
    }
    profile[Stage::bending].work += static_cast<std::size_t>(stages) * part.stencils;
  }
}

template class BendingDashpots<float>;
template class BendingDashpots<double>;

}  // namespace weft
