// Finds particles with implausible motion.

#include "core/solver/blow_up.h"

#include <cassert>
#include <cmath>

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
                                   Real dt) {
  assert(dt > 0);
  assert(state.x.size() == model.mass.size() && state.v.size() == model.mass.size());
  const auto farthest = static_cast<Real>(kFarthestFromOrigin);
  const Real per_component = 1 / std::sqrt(Real(3));  // of a vector as long as the limit
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    if (state.is_asleep(p)) continue;
    const ClothPart<Real>& part = model.parts[p];
    const Real fastest = part.rest_diagonal / dt + static_cast<Real>(kPlausibleSpeed);
    const auto first = static_cast<std::size_t>(part.particles.first);
    const auto count = static_cast<std::size_t>(part.particles.count);
    if (!any_beyond((state.v.data() + first)->data(), 3 * count, fastest * per_component) &&
        !any_beyond((state.x.data() + first)->data(), 3 * count, farthest * per_component))
      continue;
    for (std::size_t i = first; i < first + count; ++i) {
      const auto found =
          judge<Real>(state.x[i], state.v[i], farthest, fastest, static_cast<Index>(i));
      if (found) return found;
    }
  }
  return std::nullopt;
}

template std::optional<BlowUp> find_blow_up(const ClothModel<float>&, const ClothState<float>&,
                                            float);
template std::optional<BlowUp> find_blow_up(const ClothModel<double>&, const ClothState<double>&,
                                            double);

}  // namespace weft
