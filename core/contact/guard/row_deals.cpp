// Puts rows into blocks, and sweeps those.

#include "core/contact/guard/row_deals.h"

#include <cassert>
#include <limits>
#include <utility>

namespace weft {
namespace {

/// With fewer rows threads take longer to meet than blocks take to respond.
constexpr std::size_t kFewRows = 2000;

RowBatch batch_of(Index row) {
  RowBatch batch;
  batch.fill(kNone);
  batch.front() = row;
  return batch;
}

/// The first batch from `at` on that has room. Shortens the search for later calls.
/// @param open  of each batch itself or a later one, up to which there is no room
std::size_t first_open(std::vector<Index>& open, std::size_t at) {
  while (at < open.size() && open[at] != static_cast<Index>(at)) {
    const auto next = at_index(open[at]);
    if (next < open.size()) open[at] = open[next];
    at = next;
  }
  return at;
}

}  // namespace

template <class Real>
void RowDeals<Real>::clear() {
  for (std::vector<RowBlock<Real>>& blocks : blocks_) blocks.clear();
  forget_pushes();
  few_ = true;
  changed_ = false;
}

template <class Real>
void RowDeals<Real>::take(const RowSlabs<Real>& slabs, std::span<const GuardRow<Real>> rows,
                          std::size_t particles, Executor* executor) {
  assert(slabs.size() <= rows.size());
  next_batch_.resize(particles, 0);
  few_ = slabs.size() < kFewRows;
  changed_ = false;
  number_batches(slabs);
  for_every_second<kDeals>(few_ ? nullptr : executor, true, [&](std::size_t number) {
    if (has_changed(number, slabs)) deal(number, slabs, rows);
    blocks_[number].resize(batches_[number].size());
    take_rows(batches_[number], rows, blocks_[number]);
  });
}

/// Whether the lists of a deal have changed since it was made: what rests keeps its busy rows from
/// look to look.
template <class Real>
bool RowDeals<Real>::has_changed(std::size_t number, const RowSlabs<Real>& slabs) {
  bool changed = false;
  for (std::size_t list = 0; list < RowSlabs<Real>::kLists; ++list) {
    if (deal_of(list) != number) continue;
    changed |= std::exchange(changes_[list], slabs.changes(list)) != slabs.changes(list);
  }
  return changed;
}

/// Gives each deal its own range of numbers. They rise in the order in which deals are made: what
/// went into one before, or was dealt another time, has smaller ones.
template <class Real>
void RowDeals<Real>::number_batches(const RowSlabs<Real>& slabs) {
  std::array<std::size_t, kDeals> rows{};
  std::size_t all = 0;
  for (std::size_t list = 0; list < RowSlabs<Real>::kLists; ++list) {
    rows[deal_of(list)] += slabs.list(list).size();
    all += slabs.list(list).size();
  }
  if (all >= std::numeric_limits<std::uint32_t>::max() - batches_dealt_) {
    std::fill(next_batch_.begin(), next_batch_.end(), 0);
    batches_dealt_ = 0;
  }
  for_every_second<kDeals>(nullptr, true, [&](std::size_t number) {
    first_batch_[number] = batches_dealt_;
    batches_dealt_ += static_cast<std::uint32_t>(rows[number]);
  });
}

/// Rows of two slabs in turn, so that their batches fill alike.
template <class Real>
void RowDeals<Real>::deal(std::size_t number, const RowSlabs<Real>& slabs,
                          std::span<const GuardRow<Real>> rows) {
  batches_[number].clear();
  open_[number].clear();
  static const std::vector<Index> no_rows;
  const bool is_long = number == kPairs;
  const std::vector<Index>& a = slabs.list(is_long ? RowSlabs<Real>::kSlabs : number);
  const std::vector<Index>& b = is_long ? no_rows : slabs.list(number + kPairs);
  const auto deal_row = [&](Index row) { deal(number, row, rows[at_index(row)].particle); };
  for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
    if (k < a.size()) deal_row(a[k]);
    if (k < b.size()) deal_row(b[k]);
  }
}

/// Puts a row into the first batch that has room and is behind those of all rows before it that
/// have a particle in common with it.
template <class Real>
void RowDeals<Real>::deal(std::size_t number, Index row, const std::array<Index, 4>& particles) {
  std::vector<RowBatch>& batches = batches_[number];
  std::vector<Index>& open = open_[number];
  const std::uint32_t first = first_batch_[number];
  std::uint32_t behind = first;
  for (const Index i : particles) behind = std::max(behind, next_batch_[at_index(i)]);
  const std::size_t at = first_open(open, behind - first);
  if (at == batches.size()) {
    open.push_back(static_cast<Index>(at));
    batches.push_back(batch_of(row));
  } else {
    *std::find(batches[at].begin(), batches[at].end(), kNone) = row;
  }
  if (batches[at].back() != kNone) open[at] = static_cast<Index>(at + 1);
  for (const Index i : particles)
    next_batch_[at_index(i)] = first + static_cast<std::uint32_t>(at) + 1;
}

template <class Real>
void RowDeals<Real>::add(std::size_t list, Index row, std::span<const GuardRow<Real>> rows) {
  assert(list < RowSlabs<Real>::kLists && at_index(row) < rows.size());
  blocks_[deal_of(list)].emplace_back(batch_of(row), rows);
}

template <class Real>
void RowDeals<Real>::give_back(std::span<GuardRow<Real>> rows, Executor* executor) {
  if (!changed_) return;
  changed_ = false;
  run_chunks(few_ ? nullptr : executor, static_cast<int>(kDeals), [&](int number) {
    for (const RowBlock<Real>& block : blocks_[at_index(number)]) block.give_back(rows);
  });
}

template <class Real>
void RowDeals<Real>::note_pushes(Real force_ratio) {
  for (std::size_t number = 0; number < kDeals; ++number) {
    const std::vector<RowBlock<Real>>& blocks = blocks_[number];
    pushed_[number].resize(blocks.size());  // with zeros
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < kBatchRows; ++k)
          pushed_[number][b][axis][k] +=
              (blocks[b].normal[axis][k] * blocks[b].push[k] + blocks[b].drag[axis][k]) *
              force_ratio;
      }
    }
  }
}

template <class Real>
void RowDeals<Real>::log_pushes(std::span<const GuardRow<Real>> rows, GuardLog& log) {
  for (std::size_t number = 0; number < kDeals; ++number) {
    for (std::size_t b = 0; b < pushed_[number].size(); ++b) {
      const RowBlock<Real>& block = blocks_[number][b];
      for (std::size_t k = 0; k < block.count; ++k) {
        const auto& [x, y, z] = pushed_[number][b];
        const Vec3d impulse(x[k], y[k], z[k]);
        if (!impulse.isZero(0)) log_impulse(rows[at_index(block.row[k])], impulse, log);
      }
    }
  }
  forget_pushes();
}

template <class Real>
void RowDeals<Real>::forget_pushes() {
  for (auto& pushed : pushed_) pushed.clear();
}

template <class Real>
bool RowDeals<Real>::pushes() const {
  return std::any_of(blocks_.begin(), blocks_.end(), [](const auto& blocks) {
    return std::any_of(blocks.begin(), blocks.end(), [](const RowBlock<Real>& block) {
      return std::any_of(block.push.begin(), block.push.end(), [](Real push) { return push > 0; });
    });
  });
}

template class RowDeals<float>;
template class RowDeals<double>;

}  // namespace weft
