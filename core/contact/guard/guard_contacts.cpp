// Reads contacts out of the guard's rows.

#include "core/contact/guard/guard_contacts.h"

#include "core/contact/constants.h"

namespace weft {

template <class Real>
std::vector<ContactPoint> contacts_of(const ClothGuard<Real>& guard, const Vec3Array<Real>& x) {
  const auto time = static_cast<double>(guard.kicked());
  const double per_time = time > 0 ? 1 / time : 0;
  std::vector<ContactPoint> contacts;
  for (const GuardRow<Real>& row : guard.rows()) {
    ContactPoint c;
    c.count = 4;
    c.first_side = static_cast<int>(first_side(kind_of(row)));
    c.normal = to_vector(row.normal).template cast<double>();
    Vec3d other = Vec3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      c.particle[k] = row.particle[k];
      c.weight[k] = static_cast<double>(row.weight[k]);
      const Vec3d part = x[at_index(row.particle[k])].template cast<double>() * c.weight[k];
      (k < at_index(c.first_side) ? c.point : other) += part;
    }
    c.gap = c.normal.dot(c.point + other);
    c.normal_force = static_cast<double>(row.push) * per_time;
    c.friction = row.push > 0 ? Vec3d(to_vector(row.drag).template cast<double>() * per_time)
                              : Vec3d(Vec3d::Zero());
    if (row.push > 0 || c.gap <= static_cast<double>(row.radius) * kTouching) contacts.push_back(c);
  }
  return contacts;
}

template std::vector<ContactPoint> contacts_of(const ClothGuard<float>&, const Vec3Array<float>&);
template std::vector<ContactPoint> contacts_of(const ClothGuard<double>&, const Vec3Array<double>&);

}  // namespace weft
