#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/guard/guard_log.h"
#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/row_blocks.h"
#include "core/contact/guard/row_slabs.h"
#include "core/executor.h"
#include "core/types.h"

// Batches of rows that threads sweep at the same time.

namespace weft {

/// The busy rows of slabs, dealt into blocks: two slabs that have no particle in common together,
/// and the long rows. Rows with a particle in common keep their order, so that one block after the
/// other, or all the other way, gives the bits of one row after the other.
template <class Real>
class RowDeals {
 public:
  static constexpr std::size_t kPairs = RowSlabs<Real>::kSlabs / 2, kDeals = kPairs + 1;

  /// Forgets all rows.
  void clear();
  /// Takes over the busy rows.
  /// @param particles  number of all
  void take(const RowSlabs<Real>& slabs, std::span<const GuardRow<Real>> rows,
            std::size_t particles, Executor* executor);
  /// Takes over a row that came later. @param list  of the slabs, to which it was added
  void add(std::size_t list, Index row, std::span<const GuardRow<Real>> rows);
  /// Gives back what responses have changed since the rows were taken over or given back.
  void give_back(std::span<GuardRow<Real>> rows, Executor* executor);
  /// Adds up what the rows push in this step, until it is logged or forgotten.
  /// @param force_ratio  see Collision::before_drift
  void note_pushes(Real force_ratio);
  /// Logs what was added up. Call before rows are taken over anew.
  void log_pushes(std::span<const GuardRow<Real>> rows, GuardLog& log);
  void forget_pushes();
  /// Whether any row pushes.
  bool pushes() const;

  /// Calls visit(blocks) for all of each deal, where it may change what belongs to these and their
  /// particles.
  /// @param executor  does what it does on its threads if that is worth while; may be null
  /// @param upwards   visit goes from the first block to the last, or the other way
  /// @return largest of the numbers from these calls, and 0
  template <class Visit>
  Real largest(Executor* executor, bool upwards, Visit&& visit) {
    std::array<Real, kDeals> of_deal{};
    changed_ = true;
    for_every_second<kDeals>(few_ ? nullptr : executor, upwards, [&](std::size_t deal) {
      of_deal[deal] = visit(std::span<RowBlock<Real>>(blocks_[deal]));
    });
    return *std::max_element(of_deal.begin(), of_deal.end());
  }

  /// All blocks of a deal, of kDeals.
  std::span<const RowBlock<Real>> blocks(std::size_t deal) const { return blocks_[deal]; }

 private:
  static std::size_t deal_of(std::size_t list) {
    return list == RowSlabs<Real>::kSlabs ? kPairs : list % kPairs;
  }
  bool has_changed(std::size_t number, const RowSlabs<Real>& slabs);
  void number_batches(const RowSlabs<Real>& slabs);
  void deal(std::size_t number, const RowSlabs<Real>& slabs, std::span<const GuardRow<Real>> rows);
  void deal(std::size_t number, Index row, const std::array<Index, 4>& particles);

  std::array<std::vector<RowBlock<Real>>, kDeals> blocks_;
  /// Of each block, impulses of its rows that were added up [N s]; empty if none was.
  std::array<std::vector<std::array<typename RowBlock<Real>::Numbers, 3>>, kDeals> pushed_;
  std::array<std::vector<RowBatch>, kDeals> batches_;  ///< before they are blocks
  std::array<std::vector<Index>, kDeals> open_;  ///< from each batch on, the next that has room
  /// Change counter of each list when it was last dealt.
  std::array<std::uint64_t, RowSlabs<Real>::kLists> changes_{};
  /// The first batch that each particle may be in, counted through all deals of all times.
  std::vector<std::uint32_t> next_batch_;
  std::array<std::uint32_t, kDeals> first_batch_{};  ///< of each deal, counted so
  std::uint32_t batches_dealt_ = 0;                  ///< at most
  bool few_ = true, changed_ = false;
};

extern template class RowDeals<float>;
extern template class RowDeals<double>;

}  // namespace weft
