// Passes of the dashpots of quadratic bending by stabilised explicit stages.

#include "core/solver/bending_dashpots.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
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

/// Adds K v to `product` at a band's particles.
template <class Part, class Band, class Real>
void multiply(Part& part, const Band& band, const QuadArray<Real>& v, QuadArray<Real>& product) {
  for (std::size_t f = 0; f < part.families.size(); ++f) {
    for (const DashpotRun& run : band.touching[f])
      multiply_dashpots(run, v.data(), band.first, band.end, part.families[f], product.data());
  }
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
    divide(part.particles, list);
  }
  const std::size_t particles = parts_.empty() ? 0 : model.mass.size();
  for (QuadArray<Real>* array : {&start_, &now_, &before_, &change_, &next_change_, &product_})
    array->assign(particles, {});
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
void BendingDashpots<Real>::divide(const IndexRange& particles, Part& part) const {
  const auto first = static_cast<std::size_t>(particles.first),
             count = static_cast<std::size_t>(particles.count);
  part.whole = {first, first + count, {}, {}};
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
        const auto own = std::count_if(
            place, place + static_cast<std::ptrdiff_t>(places),
            [&](std::uint32_t at) { return at >= 4 * band.first && at < 4 * band.end; });
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

/// Finds the geometry of all stencils.
template <class Real>
void BendingDashpots<Real>::aim(Part& part, Executor* executor, const Vec3Array<Real>& x) {
  for_bands(part, executor, [&](const Band& band) {
    to_quads(std::span<const Vec3<Real>>(x).subspan(band.first, band.end - band.first),
             change_.data() + band.first);
  });
  for_bands(part, executor, [&](const Band& band) {
    for (std::size_t f = 0; f < part.families.size(); ++f)
      aim_dashpots(band.shares[f], change_.data(), part.families[f]);
  });
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
void BendingDashpots<Real>::open(Part& part, const Band& band, Real by_start,
                                 const std::vector<Real>& inverse_mass) {
  multiply(part, band, change_, start_);
  for (std::size_t i = band.first; i < band.end; ++i) {
    now_[i] = start_[i] * by_start;
    next_change_[i] = now_[i] * inverse_mass[i];
  }
}

/// A later stage, into `before_`. Other bands read `change_` meanwhile.
template <class Real>
void BendingDashpots<Real>::advance(Part& part, const Band& band, const Factors& by,
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
void BendingDashpots<Real>::pass(Part& part, int stages, Real seconds, Executor* executor,
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
  for (Part& part : parts_) {
    if (state.is_asleep(part.number)) continue;
    const ClothPart<Real>& cloth = model.parts[part.number];
    const int stages = stages_of(cloth, seconds);
    aim(part, executor, state.x);
    pass(part, stages, static_cast<Real>(seconds), executor, state);
    for (Index i = cloth.particles.first; held && i < cloth.particles.end(); ++i) {
      const Vec3<Real> impulse = to_vector(now_[static_cast<std::size_t>(i)]);
      if (held->holds(i)) held->push(i, impulse.template cast<double>());
    }
    profile[Stage::bending].work += static_cast<std::size_t>(stages) * part.stencils;
  }
}

template class BendingDashpots<float>;
template class BendingDashpots<double>;

}  // namespace weft
