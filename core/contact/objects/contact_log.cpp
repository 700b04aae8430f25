// Adds up the impulses of contacts over a tick.

#include "core/contact/objects/contact_log.h"

#include <algorithm>
#include <tuple>

namespace weft {

void ContactLog::want(bool wanted) {
  wanted_ = wanted;
  if (!wanted) entries_ = {};
}

/// Entries of the same particles with the same object come together.
bool ContactLog::before(const Entry& a, const Entry& b) {
  const auto key = [](const ContactPoint& c) { return std::tie(c.collider, c.count, c.particle); };
  return key(a.contact) < key(b.contact);
}

/// One contact for all entries of the same particles with the same object, which may have been
/// pushed by several of its triangles. Its geometry is that of the latest entry; friction is what
/// goes across the direction in which it was pushed.
std::vector<ContactPoint> ContactLog::merged(std::vector<Entry> entries, double seconds) {
  std::stable_sort(entries.begin(), entries.end(), before);
  std::vector<ContactPoint> contacts;
  for (std::size_t first = 0; first < entries.size();) {
    Vec3d impulse = Vec3d::Zero(), along = Vec3d::Zero();
    std::size_t end = first;
    for (; end < entries.size() && !before(entries[first], entries[end]); ++end) {
      const Entry& entry = entries[end];
      impulse += entry.impulse;
      along += entry.contact.normal * entry.contact.normal.dot(entry.impulse);
    }
    ContactPoint contact = entries[end - 1].contact;
    if (along.norm() > 0) contact.normal = along.normalized();
    contact.normal_force = contact.normal.dot(impulse) / seconds;
    contact.friction = impulse / seconds - contact.normal * contact.normal_force;
    contacts.push_back(contact);
    first = end;
  }
  return contacts;
}

}  // namespace weft
