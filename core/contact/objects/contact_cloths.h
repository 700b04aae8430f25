#pragma once

#include <cassert>
#include <vector>

#include "core/contact/objects/cloth_patches.h"
#include "core/contact/objects/contact_row.h"
#include "core/types.h"

// What contact with objects knows of the cloths of a world.

namespace weft {

/// Settings and features of all cloths. Nothing of it changes while the world runs.
template <class Real>
struct ContactCloths {
  std::vector<ContactDef> defs;  ///< of each cloth, in the order of their particles
  ClothPatches patches;
  Real thickness = 0;    ///< the largest of all, for reaches [m]
  bool bounces = false;  ///< a cloth has restitution
};

/// The cloth that a particle belongs to.
template <class Real>
Index cloth_of(const ContactCloths<Real>& cloths, Index particle) {
  assert(!cloths.defs.empty() && particle >= 0);
  std::size_t cloth = cloths.defs.size() - 1;
  while (cloth > 0 && particle < cloths.defs[cloth].first_particle) --cloth;
  return static_cast<Index>(cloth);
}

/// Settings of the cloth of a row.
template <class Real>
const ContactDef& settings_of(const ContactCloths<Real>& cloths, const ContactRow<Real>& row) {
  return cloths.defs[at_index(row.cloth)];
}

/// Thickness of a particle's cloth [m].
template <class Real>
Real thickness_at(const ContactCloths<Real>& cloths, Index particle) {
  const auto cloth = at_index(cloth_of(cloths, particle));
  return static_cast<Real>(cloths.defs[cloth].thickness);
}

}  // namespace weft
