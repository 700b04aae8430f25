#pragma once

#include <cstddef>
#include <string>

#include "core/error.h"
#include "core/world/world_def.h"

// What a scene may cost, estimated before it is taken. Only what can be told beforehand is in the
// estimate: the solver's work on springs. What contact costs depends on what meets; the owner of
// the world bounds the time of a tick instead.

namespace weft {

/// Particles of all cloths together. A cloth of 512 x 512 is within; the frame of one is 3 MB.
inline constexpr std::size_t kMostParticles = 300'000;
/// Triangles of all cloths and of all objects, each. A mesh message has 12 bytes of each.
inline constexpr std::size_t kMostTriangles = 1'000'000;

/// Updates of a particle by the solver's springs, in one tick. One takes 3 to 5 ns where the
/// springs are a grid's and 10 where they are a mesh's, so that a tick stays below two seconds of
/// CPU.
inline constexpr double kMostTickUpdates = 1.5e8;
/// The same in a simulated second: about a minute of CPU.
inline constexpr double kMostUpdatesPerSecond = 1e10;

/// A definition that would cost more than it may.
struct CostError : DefinitionError {
  using DefinitionError::DefinitionError;
};

/// Estimate of what a tick costs without contact.
struct TickCost {
  double particles = 0;
  double substeps = 0;
  double sweeps = 1;     ///< over all springs in a substep, or what is worth as many
  double tick_rate = 0;  ///< [1/s]

  double updates() const { return particles * substeps * sweeps; }
};

/// Throws CostError where a scene has more particles or triangles than it may, before
/// anything is built.
void check_size(const WorldDef& def);

/// Sweeps over all springs that the chosen solver makes in a substep.
double sweeps_of(const WorldDef& def, SolverKind kind);

/// Throws CostError where the estimate is beyond kMostTickUpdates or kMostUpdatesPerSecond.
/// @param field  whose value is to blame, e.g. "set.wind"
/// @param value  of that field
void check_cost(const TickCost& cost, const std::string& field, const std::string& value);

}  // namespace weft
