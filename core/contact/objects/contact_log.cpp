// Adds up the impulses of contacts over a tick.

#include "core/contact/objects/contact_log.h"

#include <algorithm>
#include <tuple>

namespace weft {

void ContactLog::want(bool contacts, bool each) {
  wanted_ = contacts || each;
  each_wanted_ = each;
  if (!each) entries_ = {};
  if (!wanted_) clear();
}

void ContactLog::clear() {
  for (const Slot& slot : slots_) first_slot_[at_index(slot.contact.particle[0])] = kNone;
  slots_.clear();
  sums_.clear();
  squeezes_.clear();
  entries_.clear();
}

/// The slots as contacts, by object, number of particles and particles.
std::vector<ContactPoint> ContactLog::sorted(double seconds) {
  std::vector<const Slot*> order;
  for (const Slot& slot : slots_) order.push_back(&slot);
  const auto key = [](const ContactPoint& c) { return std::tie(c.collider, c.count, c.particle); };
  std::sort(order.begin(), order.end(),
            [&key](const Slot* a, const Slot* b) { return key(a->contact) < key(b->contact); });
  std::vector<ContactPoint> contacts;
  contacts.reserve(order.size());
  for (const Slot* slot : order) {
    ContactPoint& contact = contacts.emplace_back(slot->contact);
    if (slot->along.norm() > 0) contact.normal = slot->along.normalized();
    contact.normal_force = contact.normal.dot(slot->impulse) / seconds;
    contact.friction = slot->impulse / seconds - contact.normal * contact.normal_force;
  }
  return contacts;
}

}  // namespace weft
