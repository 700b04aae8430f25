#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/types.h"

// Contacts and their mean forces over a tick.

namespace weft {

/// A contact as it is told to others: one of the cloth with an object, or of cloths with each
/// other.
struct ContactPoint {
  Index collider = kNone;  ///< the object; kNone: the other side is cloth too
  int count = 0;           ///< particles in it: 1 to 3 with an object, 4 of cloths
  int first_side = 0;      ///< so many of them belong to the side that the normal points to
  std::array<Index, 4> particle = {0, 0, 0, 0};
  std::array<double, 4> weight = {0, 0, 0, 0};  ///< negative on the other side of cloths
  Vec3d point = Vec3d::Zero();                  ///< of the first side's mid-surface [m]
  Vec3d normal = Vec3d::Zero();                 ///< unit, towards the first side
  double gap = 0;                               ///< between the mid-surface and the other side [m]
  double normal_force = 0;                      ///< on the first side along the normal [N]
  Vec3d friction = Vec3d::Zero();               ///< on the first side, across the normal [N]

  Vec3d force() const { return normal * normal_force + friction; }
};

/// Impulses of contacts with objects over a tick, for those who want to know; else it stays empty.
class ContactLog {
 public:
  bool wanted() const { return wanted_; }
  void want(bool wanted);
  void clear() { entries_.clear(); }

  /// Notes that a row of particles got an impulse from an object.
  /// @param row       of Contact, with its particles, weights, normal and collider
  /// @param change    of the velocity of the row's point [m/s]; it is shared by mass
  template <class Real, class Row>
  void add(const Row& row, const Vec3<Real>& change, const ClothState<Real>& state) {
    double mobility = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      const double weight = row.weight[k];
      mobility +=
          weight * weight *
          static_cast<double>(state.inverse_mass[static_cast<std::size_t>(row.particle[k])]);
    }
    if (mobility > 0) note(row, change.template cast<double>() / mobility);
  }

  /// Notes an impulse of an object on a row of particles [N s].
  template <class Row>
  void add_impulse(const Row& row, const Vec3d& impulse) {
    note(row, impulse);
  }

  /// Calls visit(contact, impulse) for what was noted from `first` on, which then is the next [N
  /// s].
  template <class Visit>
  void visit_from(std::size_t& first, Visit&& visit) const {
    for (; first < entries_.size(); ++first)
      visit(entries_[first].contact, entries_[first].impulse);
  }

  /// Contacts of the tick: those that pushed, and those of `rows` that touch now.
  /// @param x        positions now [m]
  /// @param reach    touching is what is nearer than this part of the thickness
  /// @param seconds  of the tick; forces are means over it
  template <class Real, class Row>
  std::vector<ContactPoint> contacts(const std::vector<Row>& rows, const Vec3Array<Real>& x,
                                     double reach, double seconds) const;

 private:
  struct Entry {
    ContactPoint contact;
    double offset = 0;  ///< of the plane [m]
    Vec3d impulse = Vec3d::Zero();
  };

  template <class Row>
  static Entry entry_of(const Row& row) {
    Entry entry;
    ContactPoint& c = entry.contact;
    c.collider = row.collider;
    c.count = c.first_side = row.count;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      c.particle[k] = row.particle[k];
      c.weight[k] = static_cast<double>(row.weight[k]);
    }
    c.normal = row.normal.template cast<double>();
    entry.offset = static_cast<double>(row.offset);
    return entry;
  }
  template <class Row>
  void note(const Row& row, const Vec3d& impulse) {
    entries_.push_back(entry_of(row));
    entries_.back().impulse = impulse;
  }
  static bool before(const Entry& a, const Entry& b);
  static std::vector<ContactPoint> merged(std::vector<Entry> entries, double seconds);

  bool wanted_ = false;
  std::vector<Entry> entries_;
};

template <class Real, class Row>
std::vector<ContactPoint> ContactLog::contacts(const std::vector<Row>& rows,
                                               const Vec3Array<Real>& x, double reach,
                                               double seconds) const {
  std::vector<Entry> all = entries_;
  const auto measure = [&x](Entry& entry) {
    ContactPoint& c = entry.contact;
    c.point.setZero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(c.count); ++k)
      c.point += x[static_cast<std::size_t>(c.particle[k])].template cast<double>() * c.weight[k];
    c.gap = c.normal.dot(c.point) - entry.offset;
  };
  for (Entry& entry : all) measure(entry);
  for (const Row& row : rows) {
    if (!row.responds) continue;
    Entry entry = entry_of(row);
    measure(entry);
    if (entry.contact.gap <= static_cast<double>(row.thickness) * reach) all.push_back(entry);
  }
  return merged(std::move(all), seconds);
}

}  // namespace weft
