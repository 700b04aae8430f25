#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/objects/contact_row.h"
#include "core/executor.h"
#include "core/types.h"

// Contacts of single particles with objects, many at a time in vector code.

namespace weft {

/// What a step of the contact solver does to lone rows: where their particles are and what they
/// respond with. Three numbers a particle in x, v, from and given, one in reach and travel2.
template <class Real>
struct LonePass {
  Real* x = nullptr;            ///< [m]
  Real* v = nullptr;            ///< [m/s]
  Real dt = 0;                  ///< of the substep [s]
  Real slack = 0;               ///< a gap wider than the thickness by this still touches [m]
  Real push_part = 0;           ///< part of a lack that is pushed out in a step; 0: nothing is
  Real push_most = 0;           ///< but no farther than this [m]
  Real lead_most = 0;           ///< the same of what is inside [m]
  const Real* from = nullptr;   ///< where ways begin [m]
  const Real* reach = nullptr;  ///< how far each particle may go [m]
  Real* travel2 = nullptr;      ///< squared way, now or after the drift, whichever is longer [m^2]
  Real* given = nullptr;        ///< sum of what responses change velocities by, if told [m/s]
};

inline constexpr std::size_t kLoneLanes = 8;

/// The rows of as many particles that follow each other. A particle without a lone row may go any
/// distance, so that nothing is done to it.
template <class Real>
struct alignas(64) LoneBlock {
  Real normal[3][kLoneLanes];
  Real offset[kLoneLanes], thickness[kLoneLanes], friction[kLoneLanes];
  Real touch2[kLoneLanes], cross2[kLoneLanes];  ///< see RowRoom [m^2]
  Real least_speed[kLoneLanes];                 ///< that rows must reach [m/s]
  Index row[kLoneLanes];                        ///< number among all rows, or kNone
  Index first;                                  ///< particle
};

/// What a response of lone rows comes to.
template <class Real>
struct LoneResponse {
  Real largest = 0;                        ///< change of a normal velocity [m/s]
  bool within = true;                      ///< what was moved or pushed ends within its reach
  std::uint64_t friction_evaluations = 0;  ///< times friction was worked out
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

  /// Whether a row is one of them.
  bool has(std::size_t row) const {
    assert(row < is_lone_.size());
    return is_lone_[row] != 0;
  }
  /// By particle.
  const std::vector<LoneBlock<Real>>& blocks() const { return blocks_; }

  /// Works out the normal velocity that each row must reach, which is no farther down than the
  /// thickness within the step, lets each respond once (see sweep_rows), and measures the
  /// ways of those anew that have. Rows that are farther from touching than their particles go do
  /// nothing. Particles that lack thickness are moved out before, if that is asked for.
  /// @param executor  shares many rows out to its threads; may be null
  LoneResponse<Real> respond(const LonePass<Real>& pass, Executor* executor);
  /// One more response, after others have changed velocities. Ways are not measured.
  LoneResponse<Real> sweep(const LonePass<Real>& pass, Executor* executor);
  /// Calls visit(row) for each.
  template <class Visit>
  void for_each(Visit&& visit) const;
  /// Calls visit(row) for rows whose particles could cross their planes.
  /// @param travel2  squared way of each particle [m^2]
  template <class Visit>
  void for_each_crossing(const Real* travel2, Visit&& visit) const;

 private:
  std::size_t next_crossing(const Real* travel2, std::size_t block) const;

  std::vector<LoneBlock<Real>> blocks_;
  std::vector<char> is_lone_;
  std::vector<Index> row_of_;  ///< each particle: its only row; while they are found
};

template <class Real>
template <class Visit>
void LoneRows<Real>::for_each(Visit&& visit) const {
  for (const LoneBlock<Real>& block : blocks_) {
    for (const Index r : block.row)
      if (r != kNone) visit(at_index(r));
  }
}

template <class Real>
template <class Visit>
void LoneRows<Real>::for_each_crossing(const Real* travel2, Visit&& visit) const {
  for (std::size_t b = 0; (b = next_crossing(travel2, b)) < blocks_.size(); ++b) {
    const LoneBlock<Real>& block = blocks_[b];
    const Real* const way2 = travel2 + block.first;
    for (std::size_t k = 0; k < kLoneLanes; ++k)
      if (block.row[k] != kNone && !(way2[k] < block.cross2[k])) visit(at_index(block.row[k]));
  }
}

extern template class LoneRows<float>;
extern template class LoneRows<double>;

}  // namespace weft
