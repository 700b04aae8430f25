// Accumulates a hard case's measurements and compares them with its limits.

#include "core/world/verdict.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/world/constants.h"

namespace weft {
namespace {

/// Largest change of a cloth's mean height between two states [m].
template <class Real>
double change_of_heights(const ClothModel<Real>& model, const Vec3Array<Real>& from,
                         const Vec3Array<Real>& to) {
  assert(from.size() == model.mass.size() && to.size() == model.mass.size());
  double largest = 0;
  for (const ClothPart<Real>& part : model.parts) {
    double sum = 0;
    for (Index k = part.particles.first; k < part.particles.end(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      sum += static_cast<double>(to[i][1] - from[i][1]);
    }
    largest = std::max(largest, std::abs(sum) / part.particles.count);
  }
  return largest;
}

}  // namespace

template <class Real>
void Verdict<Real>::look_at_energy(const World<Real>& world) {
  const TickReport& report = world.report();
  const double now = report.energies.total();
  // Separating a start that intersects does work that is not recorded.
  if (!start_energy_ || report.time <= world.def().verdict.clear_after) {
    start_energy_ = now;
    return;
  }
  given_ += report.work + report.brought;
  worked_ += std::abs(report.work) + std::abs(report.brought);
  at_play_ = std::max(at_play_, report.energies.mechanical());
  excess_ = std::max(excess_, now - *start_energy_ - given_);
  energy_excess = at_play_ + worked_ > 0 ? excess_ / (at_play_ + worked_) : 0;
}

template <class Real>
void Verdict<Real>::look_at_rest(const World<Real>& world) {
  const VerdictDef& def = world.def().verdict;
  if (def.back_by == 0) return;
  const Vec3Array<Real>& x = world.state().x;
  const double time = world.report().time + world.tick_seconds() / 2;
  if (rest_.empty() && time >= def.rest_at) rest_ = x;
  if (time < def.back_by || !std::isnan(rest_error)) return;
  if (rest_.empty()) {  // it is to be back before it rests
    rest_error = height_error = std::numeric_limits<double>::infinity();
    return;
  }
  height_error = change_of_heights(world.model(), rest_, x);
  Vec3d mean = Vec3d::Zero();
  for (const Vec3<Real>& p : rest_) mean += p.template cast<double>();
  mean /= static_cast<double>(rest_.size());
  double off2 = 0, extent2 = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    off2 += static_cast<double>((x[i] - rest_[i]).squaredNorm());
    extent2 += (rest_[i].template cast<double>() - mean).squaredNorm();
  }
  rest_error = std::sqrt(off2 / extent2);
}

template <class Real>
void Verdict<Real>::look_at_hands(const World<Real>& world) {
  for (const Grab<Real>& hand : world.grabs().list) {
    if (hand.def.mode != GrabMode::live) continue;
    const Vec3<Real> lack = hand.target - held_point(hand, world.state().x);
    hands_lag = std::max(hands_lag, static_cast<double>(lack.norm()));
  }
}

template <class Real>
void Verdict<Real>::look(const World<Real>& world) {
  ++ticks;
  const Vec3Array<Real>& x = world.state().x;
  finite =
      finite && std::all_of(x.begin(), x.end(), [](const Vec3<Real>& p) { return p.allFinite(); });
  recoveries += world.report().divergence ? 1U : 0U;
  largest_strain = std::max(largest_strain, world.report().largest_strain);
  if (!finite) return;
  look_at_energy(world);
  look_at_rest(world);
  look_at_hands(world);
  crossing_now = counter_.count(world);
  const std::uint64_t found = crossing_now.total();
  if (world.report().time <= world.def().verdict.clear_after) {
    early_crossings += found;
  } else {
    crossings += found;
    crossed_ticks += found > 0 ? 1 : 0;
    deepest = std::max(deepest, world.deepest_penetration());
    smallest_gap = std::min(smallest_gap, weft::smallest_gap(world));
  }
  if (!world.guard()) return;
  const GuardCounts& counts = world.guard()->counts();
  lost_motion = counts.wanted > 0 ? counts.truncated / counts.wanted : 0;
}

template <class Real>
std::vector<std::string> Verdict<Real>::failures(const VerdictDef& def) const {
  std::vector<std::string> list;
  if (!finite) list.push_back("a position is not finite");
  if (crossings > 0)
    list.push_back(std::to_string(crossings) + " crossings in " + std::to_string(crossed_ticks) +
                   " ticks");
  if (deepest > 0) list.push_back(number_text(deepest) + " m inside an object");
  if (largest_strain > def.strain)
    list.push_back("a strain of " + number_text(largest_strain) + ", more than " +
                   number_text(def.strain));
  if (lost_motion > def.lost_motion)
    list.push_back("lost motion of " + number_text(lost_motion) + ", more than " +
                   number_text(def.lost_motion));
  if (energy_excess > kMostEnergyExcess)
    list.push_back(number_text(energy_excess) + " more energy than it was given, more than " +
                   number_text(kMostEnergyExcess));
  if (def.heights > 0 && height_error > def.heights)
    list.push_back("a cloth's mean height off by " + number_text(height_error) + " m, more than " +
                   number_text(def.heights));
  if (def.hands_lag > 0 && hands_lag > def.hands_lag)
    list.push_back("a hand " + number_text(hands_lag) + " m from its target, more than " +
                   number_text(def.hands_lag));
  if (def.heights == 0 && rest_error > kMostRestError)
    list.push_back("off its rest by " + number_text(rest_error) + ", more than " +
                   number_text(kMostRestError));
  return list;
}

template class Verdict<float>;
template class Verdict<double>;

}  // namespace weft
