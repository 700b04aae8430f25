// Finds particles with implausible motion.

#include "core/solver/blow_up.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/solver/awake_cloths.h"

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

/// Largest numbers that a plausible motion has.
template <class Real>
struct PlausibleMotion {
  Real farthest;  ///< from the origin [m]
  Real fastest;   ///< of the particles of a cloth [m/s]

  PlausibleMotion(const ClothPart<Real>& part, Real dt)
      : farthest(static_cast<Real>(kFarthestFromOrigin)),
        fastest(part.rest_diagonal / dt + static_cast<Real>(kPlausibleSpeed)) {}
};

/// Whether the motion of any of consecutive particles may be implausible: a component is as large
/// as the limit of a whole vector allows each of three to be.
template <class Real>
bool any_suspect(const ClothState<Real>& state, std::size_t first, std::size_t count,
                 const PlausibleMotion<Real>& limit) {
  const Real per_component = 1 / std::sqrt(Real(3));  // of a vector as long as the limit
  return any_beyond((state.v.data() + first)->data(), 3 * count, limit.fastest * per_component) ||
         any_beyond((state.x.data() + first)->data(), 3 * count, limit.farthest * per_component);
}

template <class Real>
std::optional<BlowUp> judge(const Vec3<Real>& x, const Vec3<Real>& v,
                            const PlausibleMotion<Real>& limit, Index particle) {
  using Kind = BlowUp::Kind;
  if (!x.allFinite() || !v.allFinite()) return BlowUp{Kind::not_finite, particle, 0};
  // In double: squares of large floats overflow.
  const double speed = v.template cast<double>().norm();
  if (speed > static_cast<double>(limit.fastest)) return BlowUp{Kind::too_fast, particle, speed};
  const double distance = x.template cast<double>().norm();
  if (distance > static_cast<double>(limit.farthest))
    return BlowUp{Kind::too_far, particle, distance};
  return std::nullopt;
}

}  // namespace

template <class Real>
std::optional<BlowUp> find_blow_up(const ClothModel<Real>& model, const ClothState<Real>& state,
                                   Real dt, Executor* executor) {
  assert(dt > 0);
  assert(state.x.size() == model.mass.size() && state.v.size() == model.mass.size());
  const auto look = [&](std::size_t p, std::size_t first, std::size_t last) {
    return any_suspect(state, first, last - first, {model.parts[p], dt});
  };
  if (!any_of_awake(model, state, kPassedAtLeast, executor, look)) return std::nullopt;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    if (state.is_asleep(p)) continue;
    const IndexRange& range = model.parts[p].particles;
    for (Index i = range.first; i < range.end(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const auto found = judge<Real>(state.x[k], state.v[k], {model.parts[p], dt}, i);
      if (found) return found;
    }
  }
  return std::nullopt;
}

template <class Real>
void hold_back(const ClothModel<Real>& model, Real dt, Vec3Array<Real>& displacements) {
  assert(dt > 0 && displacements.size() == model.mass.size());
  const double most = kPlausibleSpeed * static_cast<double>(dt);
  for (const ClothPart<Real>& part : model.parts) {
    const auto first = displacements.begin() + part.particles.first;
    const auto end = first + part.particles.count;
    double longest = 0;
    for (auto d = first; d != end; ++d)
      longest = std::max(longest, d->template cast<double>().norm());
    if (!(longest > most)) continue;
    const auto factor = static_cast<Real>(most / longest);
    std::for_each(first, end, [factor](Vec3<Real>& d) { d *= factor; });
  }
}

template void hold_back(const ClothModel<float>&, float, Vec3Array<float>&);
template void hold_back(const ClothModel<double>&, double, Vec3Array<double>&);
template std::optional<BlowUp> find_blow_up(const ClothModel<float>&, const ClothState<float>&,
                                            float, Executor*);
template std::optional<BlowUp> find_blow_up(const ClothModel<double>&, const ClothState<double>&,
                                            double, Executor*);

}  // namespace weft
