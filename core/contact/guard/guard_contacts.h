#pragma once

#include <vector>

#include "core/contact/guard/cloth_guard.h"
#include "core/contact/objects/contact_log.h"

// Contacts of cloth with cloth as read-outs and the wire report them.

namespace weft {

/// Contacts of cloths with themselves and each other: pairs that pushed in the tick, with their
/// mean forces over it, and rows whose features touch.
/// @param x        positions now [m]
/// @param seconds  of the tick
template <class Real>
std::vector<ContactPoint> contacts_of(const ClothGuard<Real>& guard, const Vec3Array<Real>& x,
                                      double seconds);

}  // namespace weft
