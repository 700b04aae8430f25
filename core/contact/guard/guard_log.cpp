// Notes what pairs of features push in a tick, and reads contacts out of that.

#include "core/contact/guard/guard_log.h"

#include <cassert>

#include "core/contact/constants.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// The contact of a pair with its geometry of now.
/// @param from  a row, or a stopped pair
ContactPoint contact_of(const auto& from, const auto& normal) {
  ContactPoint c;
  c.count = 4;
  c.first_side = static_cast<int>(first_side(kind_of_key(from.key)));
  c.particle = from.particle;
  for (std::size_t k = 0; k < 4; ++k) c.weight[k] = static_cast<double>(from.weight[k]);
  c.normal = normal.template cast<double>();
  return c;
}

}  // namespace

void clear_log(GuardLog& log) {
  log.tally.clear();
  log.begun = false;
}

template <class Real>
void log_impulse(const GuardRow<Real>& row, const Vec3d& impulse, GuardLog& log) {
  log.tally.of(contact_of(row, to_vector(row.normal))).impulse += impulse;
}

template <class Real>
void log_meetings(const std::vector<StoppedPair<Real>>& pairs, GuardLog& log) {
  for (const StoppedPair<Real>& pair : pairs) {
    if (!(pair.pushed > 0)) continue;
    TalliedContact& one = log.tally.of(contact_of(pair, pair.normal));
    one.impulse += one.contact.normal * (static_cast<double>(pair.pushed) * log.force_ratio);
  }
}

template <class Real>
std::vector<ContactPoint> contacts_of(const GuardLog& log, const std::vector<GuardRow<Real>>& rows,
                                      const Vec3Array<Real>& x, double seconds) {
  assert(seconds > 0 && log.wanted && "what was not logged is not known");
  std::vector<ContactPoint> contacts;
  for (const TalliedContact& one : log.tally.list()) {
    ContactPoint& c = contacts.emplace_back(one.contact);
    place_contact(0, x, c);
    const Vec3d force = one.impulse / seconds;
    c.normal_force = c.normal.dot(force);
    c.friction = force - c.normal * c.normal_force;
  }
  for (const GuardRow<Real>& row : rows) {
    ContactPoint c = contact_of(row, to_vector(row.normal));
    if (log.tally.has(c)) continue;
    place_contact(0, x, c);
    if (c.gap <= static_cast<double>(row.radius) * kTouching) contacts.push_back(c);
  }
  return contacts;
}

WEFT_INSTANTIATE_FUNCTIONS(contacts_of, log_impulse, log_meetings)

}  // namespace weft
