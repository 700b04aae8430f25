#pragma once

#include <cstddef>
#include <vector>

#include "core/cloth/cloth_model.h"

// The stiffnesses of a grid's springs and bending stencils, row by row.

namespace weft {

/// The lines of coefficients of a row, in the order of GridCoefficient.
/// @param line  numbers in a line, at least as many as columns
template <class Real>
std::vector<Real> coefficient_row(const ClothPart<Real>& part, int row, std::ptrdiff_t line);

/// Acceleration by bending of a particle whose place changes by a last bit [m/s^2].
template <class Real>
double shake_of(const ClothPart<Real>& part);

}  // namespace weft
