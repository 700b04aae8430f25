#pragma once

#include <cstdint>
#include <optional>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

// The examination of a substep: one maximum over all particles, before contact sees them. No tree,
// grid or index computation meets a number that is not finite or absurd.

namespace weft {

/// No scene reaches farther from the origin [m]. Objects and cloths start within 100 m of it, and
/// beyond a kilometre single precision resolves less than the thickness of a fabric.
inline constexpr double kFarthestFromOrigin = 1000;

/// At this speed a particle may go in any case, however small its cloth is [m/s]: twice the
/// strongest wind. Above it, no particle may go farther in a substep than its cloth's diagonal.
inline constexpr double kPlausibleSpeed = 200;

/// Motion that no cloth has: the substep that led to it is unstable.
struct BlowUp {
  enum class Kind : std::uint8_t {
    not_finite,  ///< a position or velocity is NaN or infinite
    too_fast,    ///< the coming drift is longer than the cloth's rest diagonal
    too_far,     ///< more than kFarthestFromOrigin from the origin
  };
  Kind kind = Kind::not_finite;
  Index particle = kNone;
  double value = 0;  ///< its speed [m/s], or its distance from the origin [m]
};

/// Looks at all cloths that are awake.
/// @param dt  the coming drift, or the one that was last [s]; positive
/// @returns   the first particle whose motion is no cloth's, if there is one
template <class Real>
std::optional<BlowUp> find_blow_up(const ClothModel<Real>& model, const ClothState<Real>& state,
                                   Real dt);

}  // namespace weft
