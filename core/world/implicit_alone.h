#pragma once

#include <cstddef>
#include <string>

#include "core/world/world.h"

// Worlds of the solver `implicit` that verlet cannot step.

namespace weft {

/// Whether verlet would need more substeps a tick, or more updates, than any world may take.
/// @param particles  of the world
/// @param substeps   of verlet
bool is_beyond_verlet(std::size_t particles, int substeps);

/// Whether verlet cannot step the ticks that do not suit `implicit`: those in which the cloth
/// touches something, is shaken violently, or a pin moves. Contact and pins act between the
/// substeps of `implicit` and are not in their equations, so that stiff or strongly damped cloth
/// that it steps alone is torn by them. False with another solver.
///
/// Verlet is left all of these ticks that it can step with the substeps and the updates that any
/// world may take: such ticks are slow, and right.
template <class Real>
bool steps_implicit_alone(const World<Real>& world);

/// A sentence for people, of a world that it holds for.
template <class Real>
std::string describe_implicit_alone(const World<Real>& world);

}  // namespace weft
