#pragma once

#include "core/cloth/cloth_model.h"

// Threads that lock: fabric that is stiffer along them beyond a strain.

namespace weft {

/// Gives the one part of a model the locks of its fabric, if it locks: one for each edge of a grid
/// along a thread, with half of the area of the cells beside it, and two for each membrane triangle
/// of a mesh. Bounds their frequency by Gershgorin rows as if all were locked.
template <class Real>
void add_thread_locks(ClothModel<Real>& model);

}  // namespace weft
