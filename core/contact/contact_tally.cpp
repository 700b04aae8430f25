// Adds up the impulses of contacts over a tick.

#include "core/contact/contact_tally.h"

#include <utility>

#include "core/instantiate.h"

namespace weft {
namespace {

bool is_same(const ContactPoint& a, const ContactPoint& b) {
  return a.collider == b.collider && a.count == b.count && a.first_side == b.first_side &&
         a.particle == b.particle;
}

}  // namespace

void ContactTally::clear() {
  for (const TalliedContact& one : list_) last_[at_index(one.contact.particle[0])] = kNone;
  list_.clear();
}

Index ContactTally::find(const ContactPoint& contact) const {
  const auto first = at_index(contact.particle[0]);
  Index at = first < last_.size() ? last_[first] : kNone;
  while (at != kNone && !is_same(list_[at_index(at)].contact, contact))
    at = list_[at_index(at)].next;
  return at;
}

TalliedContact& ContactTally::of(const ContactPoint& contact, double offset) {
  Index at = find(contact);
  if (at == kNone) {
    const auto first = at_index(contact.particle[0]);
    if (first >= last_.size()) last_.resize(first + 1, kNone);
    at = static_cast<Index>(list_.size());
    list_.emplace_back().next = std::exchange(last_[first], at);
  }
  TalliedContact& one = list_[at_index(at)];
  one.contact = contact;
  one.offset = offset;
  return one;
}

template <class Real>
void place_contact(double offset, const Vec3Array<Real>& x, ContactPoint& contact) {
  contact.point.setZero();
  Vec3d other = Vec3d::Zero();
  for (std::size_t k = 0; k < at_index(contact.count); ++k) {
    const Vec3d part = x[at_index(contact.particle[k])].template cast<double>() * contact.weight[k];
    (k < at_index(contact.first_side) ? contact.point : other) += part;
  }
  contact.gap = contact.normal.dot(contact.point + other) - offset;
}

WEFT_INSTANTIATE_FUNCTIONS(place_contact)

}  // namespace weft
