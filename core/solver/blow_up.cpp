// Finds particles with implausible motion.

#include "core/solver/blow_up.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/contact/parts.h"

namespace weft {
namespace {

/// Whether any of `count` numbers exceeds the limit or is NaN. No early exit, so that it becomes
/// vector code.
template <class Real>
bool any_beyond(const Real* values, std::size_t count, Real limit) {
  int beyond = 0;
  for (std::size_t k = 0; k < count; ++k)
    beyond |= static_cast<int>(!(std::abs(values[k]) <= limit));
  return beyond != 0;
}

/// Whether any number of consecutive vectors exceeds the limit or is NaN.
template <class Real>
bool any_beyond(const Vec3Array<Real>& values, std::size_t first, std::size_t count, Real limit) {
  return any_beyond((values.data() + first)->data(), 3 * count, limit);
}

/// Whether motion may be implausible: a component is as large as the limit of a whole vector allows
/// each of three to be.
template <class Real>
bool any_suspect(const ClothState<Real>& state, const IndexRange& range, Real farthest,
                 Real fastest, Executor* executor) {
  const Real per_component = 1 / std::sqrt(Real(3));  // of a vector as long as the limit
  const auto start = static_cast<std::size_t>(range.first);
  const auto count = static_cast<std::size_t>(range.count);
  std::array<bool, kMostParts> suspect{};
  const auto look = [&](std::size_t part, std::size_t first, std::size_t last) {
    suspect[part] = any_beyond(state.v, start + first, last - first, fastest * per_component) ||
                    any_beyond(state.x, start + first, last - first, farthest * per_component);
  };
  run_parts(executor, count, executor ? parts_of(count, kLookedAtLeast) : 1, look);
  return std::find(suspect.begin(), suspect.end(), true) != suspect.end();
}

template <class Real>
std::optional<BlowUp> judge(const Vec3<Real>& x, const Vec3<Real>& v, Real farthest, Real fastest,
                            Index particle) {
  using Kind = BlowUp::Kind;
  if (!x.allFinite() || !v.allFinite()) return BlowUp{Kind::not_finite, particle, 0};
  // In double: squares of large floats overflow.
  const double speed = v.template cast<double>().norm();
  if (speed > static_cast<double>(fastest)) return BlowUp{Kind::too_fast, particle, speed};
  const double distance = x.template cast<double>().norm();
  if (distance > static_cast<double>(farthest)) return BlowUp{Kind::too_far, particle, distance};
  return std::nullopt;
}

}  // namespace

template <class Real>
std::optional<BlowUp> find_blow_up(const ClothModel<Real>& model, const ClothState<Real>& state,
                                   Real dt, Executor* executor) {
  assert(dt > 0);
  assert(state.x.size() == model.mass.size() && state.v.size() == model.mass.size());
  const auto farthest = static_cast<Real>(kFarthestFromOrigin);
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    if (state.is_asleep(p)) continue;
    const ClothPart<Real>& part = model.parts[p];
    const Real fastest = part.rest_diagonal / dt + static_cast<Real>(kPlausibleSpeed);
    if (!any_suspect(state, part.particles, farthest, fastest, executor)) continue;
    const auto first = static_cast<std::size_t>(part.particles.first);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(part.particles.count); ++i) {
      const auto found =
          judge<Real>(state.x[i], state.v[i], farthest, fastest, static_cast<Index>(i));
      if (found) return found;
    }
  }
  return std::nullopt;
}

template std::optional<BlowUp> find_blow_up(const ClothModel<float>&, const ClothState<float>&,
                                            float, Executor*);
template std::optional<BlowUp> find_blow_up(const ClothModel<double>&, const ClothState<double>&,
                                            double, Executor*);

}  // namespace weft
