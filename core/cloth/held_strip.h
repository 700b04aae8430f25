#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/membrane.h"

// What pinned strips leave free of a mesh.

namespace weft {

/// Distance of a place (u, v) beyond the border of a strip [m]: positive where the fabric is free.
double distance_beyond(const HeldStrip& strip, const std::array<double, 2>& place);

/// Whether a strip holds what lies at (u, v) [m].
bool holds(const HeldStrip& strip, const std::array<double, 2>& place);

/// Part of a triangle's area that no strip holds [1]: 0 if each corner is held, else more.
/// @param corners  in material coordinates [m]
double free_part(const std::vector<HeldStrip>& strips, const RestCorners& corners);

}  // namespace weft
