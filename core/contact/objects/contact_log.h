#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <utility>
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
  int first_side = 0;      ///< how many belong to the side that the normal points to
  std::array<Index, 4> particle = {0, 0, 0, 0};
  std::array<double, 4> weight = {0, 0, 0, 0};  ///< negative on the other side of cloths
  Vec3d point = Vec3d::Zero();                  ///< of the first side's mid-surface [m]
  Vec3d normal = Vec3d::Zero();                 ///< unit, towards the first side
  double gap = 0;                               ///< between the mid-surface and the other side [m]
  double normal_force = 0;                      ///< on the first side along the normal [N]
  Vec3d friction = Vec3d::Zero();               ///< on the first side, across the normal [N]

  Vec3d force() const { return normal * normal_force + friction; }
};

/// Impulses of contacts with objects over a tick, if they are wanted; else it stays empty.
///
/// A substep pushes the same rows again and again, hundreds of times in a tick of a gripper. So
/// impulses are added up per row, and these sums per contact as often as rows change: a tick costs
/// an addition for each impulse, and what is done for each contact. All is added in the order in
/// which the rows are solved, hence alike with any number of threads.
class ContactLog {
 public:
  bool wanted() const { return wanted_; }
  /// Whether it wants all impulses one by one, too.
  bool wants_each() const { return each_wanted_; }
  /// @param contacts  sums, for `contacts`
  /// @param each      all impulses one by one, for `visit_from`
  void want(bool contacts, bool each);

  /// Forgets everything: a tick begins, or the rows have gone.
  void clear();

  /// Call before impulses of these rows, each time that rows were built or a tick began.
  void see(const auto& rows, const auto& state) {
    if (sums_.size() == rows.size()) return;
    sums_.clear();
    squeezes_.clear();
    for (const auto& row : rows) {
      sums_.emplace_back();
      sums_.back().mass = mass_of(row, state);
    }
  }

  /// Notes that row `r` got an impulse from an object.
  /// @param change  of the velocity of the row's point [m/s]; it is shared by mass
  [[gnu::always_inline]] void add(const auto& rows, std::size_t r, const auto& change) {
    assert(sums_.size() == rows.size() && "see comes first");
    const Vec3d impulse = change.template cast<double>() * sums_[r].mass;
    sums_[r].impulse += impulse;
    if (each_wanted_) [[unlikely]]
      enter(rows[r], impulse);
  }

  /// Notes its share of what a jaw squeezes with [N s], all of which is pressure: it acts along the
  /// jaw's press, as that of the other jaw does, however the row leans.
  void add_squeeze(const auto& rows, std::size_t r, const Vec3d& impulse) {
    assert(sums_.size() == rows.size() && "see comes first");
    squeezes_.resize(sums_.size(), Vec3d::Zero());
    squeezes_[r] += impulse;
    if (!each_wanted_) return;
    enter(rows[r], impulse);
    entries_.back().first.normal = impulse.normalized();
  }

  /// Notes what is not one of the rows: it got a change of velocity [m/s].
  void add_apart(const auto& row, const auto& change, const auto& state) {
    const Vec3d impulse = change.template cast<double>() * mass_of(row, state);
    book(row, impulse, Vec3d::Zero());
    if (each_wanted_) enter(row, impulse);
  }

  /// Call before the normal of row `r` turns: what it got belongs to the old one.
  void before_turn(const auto& rows, std::size_t r) {
    if (sums_.size() == rows.size()) book_sum(rows, r);
  }

  /// Call before rows go.
  void before_rebuild(const auto& rows) {
    if (sums_.size() == rows.size()) {
      for (std::size_t r = 0; r < rows.size(); ++r) book_sum(rows, r);
    }
    sums_.clear();
    squeezes_.clear();
  }

  /// Calls visit(contact, impulse) for each that was noted from `first` on, which then is the next
  /// [N s].
  void visit_from(std::size_t& first, auto&& visit) const {
    for (; first < entries_.size(); ++first) visit(entries_[first].first, entries_[first].second);
  }

  /// Contacts of the tick, by object and particles: those that pushed, and those of `rows` that
  /// touch now.
  /// @param x        positions now [m]
  /// @param reach    touching is what is nearer than this part of the thickness
  /// @param seconds  of the tick; forces are means over it
  std::vector<ContactPoint> contacts(const auto& rows, const auto& x, double reach, double seconds);

 private:
  /// What a row got from the solver since it was booked last.
  struct RowSum {
    Vec3d impulse = Vec3d::Zero();  ///< [N s]
    double mass = 0;                ///< impulse for a change of velocity of its point [kg]
  };
  /// A contact with all that it got in this tick. Several triangles of an object may push the same
  /// particles: the geometry is that of the last, friction what goes across the common direction.
  struct Slot {
    ContactPoint contact;
    double offset = 0;              ///< of the plane [m]
    Vec3d impulse = Vec3d::Zero();  ///< [N s]
    Vec3d along = Vec3d::Zero();    ///< its parts along the normals, and squeezes [N s]
    Index next = kNone;             ///< another with the same first particle
  };

  static ContactPoint entry_of(const auto& row) {
    ContactPoint c;
    c.collider = row.collider;
    c.count = c.first_side = static_cast<int>(row.count);
    for (std::size_t k = 0; k < row.count; ++k) c.particle[k] = row.particle[k];
    take_plane(row, c);
    return c;
  }
  static void take_plane(const auto& row, ContactPoint& c) {
    for (std::size_t k = 0; k < row.count; ++k) c.weight[k] = static_cast<double>(row.weight[k]);
    c.normal = row.normal.template cast<double>();
  }
  /// 0 if no impulse can move the row's point.
  static double mass_of(const auto& row, const auto& state) {
    double mobility = 0;
    for (std::size_t k = 0; k < row.count; ++k) {
      const double weight = row.weight[k];
      mobility +=
          weight * weight * static_cast<double>(state.inverse_mass[at_index(row.particle[k])]);
    }
    return mobility > 0 ? 1 / mobility : 0;
  }
  static bool is_of(const ContactPoint& c, const auto& row) {
    if (c.collider != row.collider || static_cast<std::size_t>(c.count) != row.count) return false;
    for (std::size_t k = 0; k < row.count; ++k) {
      if (c.particle[k] != row.particle[k]) return false;
    }
    return true;
  }
  void enter(const auto& row, const Vec3d& impulse) {
    entries_.push_back({entry_of(row), impulse});
  }
  void book_sum(const auto& rows, std::size_t r) {
    Vec3d none = Vec3d::Zero();
    Vec3d& impulse = sums_[r].impulse;
    Vec3d& squeeze = squeezes_.empty() ? none : squeezes_[r];
    if (impulse.isZero(0) && squeeze.isZero(0)) return;
    book(rows[r], impulse, squeeze);
    impulse.setZero();
    squeeze.setZero();
  }
  /// Adds impulses to the slot of a row.
  void book(const auto& row, const Vec3d& impulse, const Vec3d& squeeze) {
    Slot& slot = slot_of(row);
    slot.impulse += impulse + squeeze;
    slot.along += slot.contact.normal * slot.contact.normal.dot(impulse) + squeeze;
  }
  /// The slot of a row, new or old, with the row's plane.
  Slot& slot_of(const auto& row) {
    const auto first = at_index(row.particle[0]);
    if (first >= first_slot_.size()) first_slot_.resize(first + 1, kNone);
    Index at = first_slot_[first];
    while (at != kNone && !is_of(slots_[at_index(at)].contact, row)) at = slots_[at_index(at)].next;
    if (at == kNone) {
      at = static_cast<Index>(slots_.size());
      slots_.emplace_back();
      slots_.back().contact = entry_of(row);
      slots_.back().next = std::exchange(first_slot_[first], at);
    }
    Slot& slot = slots_[at_index(at)];
    take_plane(row, slot.contact);
    slot.offset = static_cast<double>(row.offset);
    return slot;
  }
  std::vector<ContactPoint> sorted(double seconds);

  bool wanted_ = false, each_wanted_ = false;
  std::vector<RowSum> sums_;       ///< of each row
  std::vector<Vec3d> squeezes_;    ///< of jaws, of each row; empty: none squeezes [N s]
  std::vector<Slot> slots_;        ///< in the order of their first impulse
  std::vector<Index> first_slot_;  ///< for each particle as the first of it
  std::vector<std::pair<ContactPoint, Vec3d>> entries_;  ///< all impulses, if they are wanted
};

std::vector<ContactPoint> ContactLog::contacts(const auto& rows, const auto& x, double reach,
                                               double seconds) {
  before_rebuild(rows);
  for (const auto& row : rows) {
    if (!row.responds) continue;
    Vec3d point = Vec3d::Zero();
    for (std::size_t k = 0; k < row.count; ++k)
      point +=
          x[at_index(row.particle[k])].template cast<double>() * static_cast<double>(row.weight[k]);
    const double gap =
        row.normal.template cast<double>().dot(point) - static_cast<double>(row.offset);
    if (gap <= static_cast<double>(row.thickness) * reach) slot_of(row);
  }
  for (Slot& slot : slots_) {
    ContactPoint& c = slot.contact;
    c.point.setZero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(c.count); ++k)
      c.point += x[at_index(c.particle[k])].template cast<double>() * c.weight[k];
    c.gap = c.normal.dot(c.point) - slot.offset;
  }
  return sorted(seconds);
}

}  // namespace weft
