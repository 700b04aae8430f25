#pragma once

#include <cassert>
#include <utility>
#include <vector>

#include "core/contact/contact_tally.h"
#include "core/types.h"

// Contacts with objects and their mean forces over a tick.

namespace weft {

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

  /// Says what is told for an impulse of 1 that velocities get from now on: see
  /// Collision::before_drift.
  void set_force_ratio(double ratio) { force_ratio_ = ratio; }

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
    const Vec3d impulse = change.template cast<double>() * (sums_[r].mass * force_ratio_);
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
    const Vec3d impulse = change.template cast<double>() * (mass_of(row, state) * force_ratio_);
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

  static ContactPoint contact_of(const auto& row) {
    ContactPoint c;
    c.collider = row.collider;
    c.count = c.first_side = static_cast<int>(row.count);
    for (std::size_t k = 0; k < row.count; ++k) {
      c.particle[k] = row.particle[k];
      c.weight[k] = static_cast<double>(row.weight[k]);
    }
    c.normal = row.normal.template cast<double>();
    return c;
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
  void enter(const auto& row, const Vec3d& impulse) {
    entries_.push_back({contact_of(row), impulse});
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
  /// Adds impulses to the contact of a row, which takes over the row's plane.
  void book(const auto& row, const Vec3d& impulse, const Vec3d& squeeze) {
    TalliedContact& one = tally_.of(contact_of(row), static_cast<double>(row.offset));
    one.impulse += impulse + squeeze;
    one.along += one.contact.normal * one.contact.normal.dot(impulse) + squeeze;
  }
  /// By object, number of particles and particles.
  static void sort(std::vector<ContactPoint>& contacts);

  bool wanted_ = false, each_wanted_ = false;
  double force_ratio_ = 1;
  std::vector<RowSum> sums_;     ///< of each row
  std::vector<Vec3d> squeezes_;  ///< of jaws, of each row; empty: none squeezes [N s]
  ContactTally tally_;
  std::vector<std::pair<ContactPoint, Vec3d>> entries_;  ///< all impulses, if they are wanted
};

std::vector<ContactPoint> ContactLog::contacts(const auto& rows, const auto& x, double reach,
                                               double seconds) {
  before_rebuild(rows);
  for (const auto& row : rows) {
    if (!row.responds) continue;
    ContactPoint c = contact_of(row);
    const auto offset = static_cast<double>(row.offset);
    place_contact(offset, x, c);
    if (c.gap <= static_cast<double>(row.thickness) * reach) tally_.of(c, offset);
  }
  std::vector<ContactPoint> contacts;
  contacts.reserve(tally_.list().size());
  for (const TalliedContact& one : tally_.list()) {
    ContactPoint& c = contacts.emplace_back(one.contact);
    place_contact(one.offset, x, c);
    if (one.along.norm() > 0) c.normal = one.along.normalized();
    c.normal_force = c.normal.dot(one.impulse) / seconds;
    c.friction = one.impulse / seconds - c.normal * c.normal_force;
  }
  sort(contacts);
  return contacts;
}

}  // namespace weft
