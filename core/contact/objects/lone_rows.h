#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/contact/objects/contact_row.h"
#include "core/math/aligned_vector.h"
#include "core/types.h"

namespace weft {

/// What a step of the contact solver does to lone rows: where their particles are and what they
/// respond with. Three numbers a particle in x, v and from, one in reach and travel2.
template <class Real>
struct LonePass {
  Real* x = nullptr;            ///< [m]
  Real* v = nullptr;            ///< [m/s]
  Real dt = 0;                  ///< of the substep [s]
  Real slack = 0;               ///< a gap so much wider than the thickness still touches [m]
  Real push_part = 0;           ///< part of a lack that is pushed out in a step
  Real push_most = 0;           ///< but no farther than this [m]
  const Real* from = nullptr;   ///< where ways begin [m]
  const Real* reach = nullptr;  ///< how far each particle may go [m]
  Real* travel2 = nullptr;      ///< squared way, now or after the drift, whichever is longer [m^2]
};

/// What the kernels of LoneRows read and write: a number a row in each array.
template <class Real>
struct LoneView {
  std::size_t count = 0;
  const Index* particle = nullptr;
  const Real* normal[3] = {};
  const Real *offset = nullptr, *thickness = nullptr, *friction = nullptr;
  const Real *touch2 = nullptr, *cross2 = nullptr;
  Real *least_speed = nullptr, *pushed = nullptr;
};

/// Contacts with objects at rest of particles that are in no other contact: nearly all of a cloth
/// that lies on the ground or a ball. As none knows of another they are worked on several at a
/// time, component by component, by vector code chosen for the processor when the program runs,
/// with the bits that one after the other gives.
template <class Real>
class LoneRows {
 public:
  /// Looks for them among all rows: those that respond without a bounce to an object at rest.
  /// @param rooms   of the rows
  /// @param cloths  whose friction and restitution rows have
  void find(const std::vector<ContactRow<Real>>& rows, const std::vector<RowRoom<Real>>& rooms,
            const std::vector<ContactDef>& cloths, std::size_t particles);
  void clear();

  std::size_t size() const { return row_.size(); }
  /// Whether a row is one of them.
  bool has(std::size_t row) const { return is_lone_[row] != 0; }
  /// Number among all rows.
  std::size_t row(std::size_t k) const { return row_[k]; }

  /// Nobody has been moved yet in this step.
  void begin_step() { pushed_.assign(row_.size(), Real(0)); }
  /// Sets the normal velocity that each row must reach: no farther down than the thickness within
  /// the step. Rows that are farther from touching than their particles go reach any.
  void aim(const LonePass<Real>& pass);
  /// The same after moving out particles that lack thickness.
  void push_and_aim(const LonePass<Real>& pass);
  /// One response of each row (see Contact::sweep_rows).
  /// @param evaluations  counts those of friction
  /// @return largest change of a normal velocity [m/s]
  Real sweep(const LonePass<Real>& pass, std::uint64_t& evaluations);
  /// Measures the ways of those anew that were moved or pushed in this step.
  /// @return whether all end within their reach
  bool measure_pushed(const LonePass<Real>& pass);
  /// The first row from number k on whose particle could cross its plane; size() if there is none.
  std::size_t next_crossing(const Real* travel2, std::size_t k);

 private:
  LoneView<Real> view();

  std::vector<std::size_t> row_;
  std::vector<char> is_lone_;
  std::vector<Index> particle_;  ///< ascending, so that most have their neighbours beside them
  std::array<AlignedVector<Real>, 3> normal_;
  AlignedVector<Real> offset_, thickness_, friction_;
  AlignedVector<Real> touch2_, cross2_;       ///< [m^2]
  AlignedVector<Real> least_speed_, pushed_;  ///< [m/s]; 1 for who was moved or pushed, else 0
  std::vector<Index> row_of_;                 ///< each particle: its only row; while they are found
};

extern template class LoneRows<float>;
extern template class LoneRows<double>;

}  // namespace weft
