// Reads contacts out of what the guard has logged, and of its rows.

#include "core/contact/guard/guard_contacts.h"

#include <cassert>

#include "core/contact/constants.h"

namespace weft {
namespace {

/// A contact of two features without its force, where its particles are now.
/// @param key  of the pair
ContactPoint contact_at(std::uint64_t key, const std::array<Index, 4>& particle,
                        const std::array<double, 4>& weight, const Vec3d& normal, const auto& x) {
  ContactPoint c;
  c.count = 4;
  c.first_side = static_cast<int>(first_side(kind_of_key(key)));
  c.particle = particle;
  c.weight = weight;
  c.normal = normal;
  Vec3d other = Vec3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3d part = x[at_index(particle[k])].template cast<double>() * weight[k];
    (k < at_index(c.first_side) ? c.point : other) += part;
  }
  c.gap = normal.dot(c.point + other);
  return c;
}

}  // namespace

template <class Real>
std::vector<ContactPoint> contacts_of(const ClothGuard<Real>& guard, const Vec3Array<Real>& x,
                                      double seconds) {
  const GuardLog& log = guard.log();
  assert(seconds > 0 && log.wanted && "what was not logged is not known");
  std::vector<ContactPoint> contacts;
  for (const LoggedPair& pair : log.pairs) {
    ContactPoint& c =
        contacts.emplace_back(contact_at(pair.key, pair.particle, pair.weight, pair.normal, x));
    const Vec3d force = pair.impulse / seconds;
    c.normal_force = c.normal.dot(force);
    c.friction = force - c.normal * c.normal_force;
  }
  for (const GuardRow<Real>& row : guard.rows()) {
    if (is_logged(log, row.key, row.particle[0])) continue;
    std::array<double, 4> weight;
    for (std::size_t k = 0; k < 4; ++k) weight[k] = static_cast<double>(row.weight[k]);
    const Vec3d normal = to_vector(row.normal).template cast<double>();
    const ContactPoint c = contact_at(row.key, row.particle, weight, normal, x);
    if (c.gap <= static_cast<double>(row.radius) * kTouching) contacts.push_back(c);
  }
  return contacts;
}

template std::vector<ContactPoint> contacts_of(const ClothGuard<float>&, const Vec3Array<float>&,
                                               double);
template std::vector<ContactPoint> contacts_of(const ClothGuard<double>&, const Vec3Array<double>&,
                                               double);

}  // namespace weft
