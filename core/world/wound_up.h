#pragma once

#include <cstddef>
#include <string>

#include "core/cloth/cloth_model.h"
#include "core/types.h"

// Changes of a fabric that would wind the present shape up like a spring.

namespace weft {

/// Throws DefinitionError if the present shape of a cloth, as a change makes it, has the energy to
/// throw the cloth at more than kFastestRelease, beyond what it had for each kilogram: released it
/// would crash through its own folds at hundreds of metres a second, in ticks of seconds. A cloth
/// becomes stiffer, or lighter with what it stores.
/// @param before,after  the change, of the same mesh
/// @param x             positions [m]
/// @param field         which the change has set
template <class Real>
void refuse_wound_up(const ClothModel<Real>& before, const ClothModel<Real>& after,
                     std::size_t cloth, const Vec3Array<Real>& x, const std::string& field);

}  // namespace weft
