#pragma once

#include <vector>

#include "core/contact/guard/row_set.h"
#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// The push that leads features apart that are too near, without giving them velocity.

namespace weft {

/// Velocities of a push, which last for one drift.
template <class Real>
struct PushOut {
  QuadArray<Real> extra;         ///< velocity of the push [m/s]; 0 where nothing is pushed
  std::vector<char> is_pushed;   ///< of each particle
  std::vector<Index> particles;  ///< those that are pushed
  Vec3Array<Real> v;             ///< their velocities with it [m/s]
};

/// @param particles  number of all
template <class Real>
PushOut<Real> push_out(std::size_t particles);

/// Adds to the velocities what leads lacking rows apart.
template <class Real>
void add_push(RowSet<Real>& rows, PushOut<Real>& push, Vec3Array<Real>& v, Executor* executor);

/// Takes the push out of the velocities again, after the drift.
template <class Real>
void take_back_push(PushOut<Real>& push, Vec3Array<Real>& v);

/// Forgets a push that was not taken back; keeps its memory.
template <class Real>
void forget_push(PushOut<Real>& push);

}  // namespace weft
