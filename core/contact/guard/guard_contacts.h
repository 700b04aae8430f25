#pragma once

#include <vector>

#include "core/contact/guard/cloth_guard.h"
#include "core/contact/objects/contact_log.h"

// Contacts of cloth with cloth as read-outs and the wire report them.

namespace weft {

/// Contacts of cloths with themselves and each other: the guard's rows that push, and those whose
/// features touch. Forces are those of the last kick.
/// @param x  positions now [m]
template <class Real>
std::vector<ContactPoint> contacts_of(const ClothGuard<Real>& guard, const Vec3Array<Real>& x);

}  // namespace weft
