// Tells which numbers of its fabric make a cloth need many substeps.

#include "core/world/substep_causes.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/cloth/stability_bound.h"

namespace weft {
namespace {

using Shares = std::vector<std::pair<double, std::string>>;

/// Shares out a bound among the fields that it grows with.
void share_out(double bound, const Shares& fields, Shares& shares) {
  double sum = 0;
  for (const auto& [weight, field] : fields) sum += weight;
  for (const auto& [weight, field] : fields)
    shares.emplace_back(sum > 0 ? bound * weight / sum : 0, field);
}

void append_sorted(Shares shares, std::vector<std::string>& fields) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [share, field] : shares) fields.push_back(field);
}

}  // namespace

template <class Real>
SubstepCauses substep_causes(const ClothPart<Real>& part, SolverKind kind, double tick_seconds) {
  assert(kind != SolverKind::automatic && tick_seconds > 0);
  if (kind == SolverKind::implicit) return {};
  const FabricDef& f = part.fabric;
  FrequencyBounds b = part.bounds;
  if (kind == SolverKind::relaxation)  // its membrane is solved for
    b.membrane_omega2 = b.locking_omega2 = b.membrane_damping_rate = 0;
  const double omega2 = b.membrane_omega2 + b.locking_omega2 + b.bending_omega2;
  const double rate = b.membrane_damping_rate + b.bending_damping_rate;
  Shares stiff, damped;
  share_out(
      b.membrane_omega2,
      {{f.stretch_warp, "stretch_warp"}, {f.stretch_weft, "stretch_weft"}, {f.shear, "shear"}},
      stiff);
  share_out(b.locking_omega2, {{1, "locking_factor"}, {0, "locking_strain"}}, stiff);
  share_out(b.bending_omega2, {{f.bending_warp, "bending_warp"}, {f.bending_weft, "bending_weft"}},
            stiff);
  share_out(b.membrane_damping_rate,
            {{f.stretch_damping, "stretch_damping"},
             {f.shear_damping, "shear_damping"},
             {least_relaxation_time(part), "damping_ratio"}},
            damped);
  share_out(b.bending_damping_rate, {{1, "bending_damping"}}, damped);
  SubstepCauses causes;
  causes.damping = 2 * substeps_for({omega2, 0}, tick_seconds, 1) <
                   substeps_for({omega2, rate}, tick_seconds, 1);
  append_sorted(causes.damping ? damped : stiff, causes.fields);
  append_sorted(causes.damping ? stiff : damped, causes.fields);
  causes.fields.insert(causes.fields.end(), {"areal_density", "poisson"});
  return causes;
}

template SubstepCauses substep_causes(const ClothPart<float>&, SolverKind, double);
template SubstepCauses substep_causes(const ClothPart<double>&, SolverKind, double);

}  // namespace weft
