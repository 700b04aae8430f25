// Begins the log of contacts with objects, and orders what is read out of it.

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
  tally_.clear();
  sums_.clear();
  squeezes_.clear();
  entries_.clear();
}

void ContactLog::sort(std::vector<ContactPoint>& contacts) {
  const auto key = [](const ContactPoint& c) { return std::tie(c.collider, c.count, c.particle); };
  std::sort(contacts.begin(), contacts.end(),
            [&key](const ContactPoint& a, const ContactPoint& b) { return key(a) < key(b); });
}

}  // namespace weft
