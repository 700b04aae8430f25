#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// Slices of space, so that several threads sweep rows with the bits of one.

namespace weft {

/// Two-colour schedule: runs work(k) for all even k below Parts - 1 in parallel, then for all odd
/// ones, then for the last alone. Parts of one colour share no particle.
/// @param upwards  in this order, or in reverse
template <std::size_t Parts, class Work>
void for_every_second(Executor* executor, bool upwards, Work&& work) {
  const auto from = [&](std::size_t first) {
    run_chunks(executor, static_cast<int>(Parts / 2),
               [&](int chunk) { work(2 * static_cast<std::size_t>(chunk) + first); });
  };
  if (!upwards) work(Parts - 1);
  from(upwards ? 0 : 1);
  from(upwards ? 1 : 0);
  if (upwards) work(Parts - 1);
}

/// Rows of contact, sorted so that they can be swept on several threads with the same bits as on
/// one. Space is cut into slabs with equally many particles, and a row belongs to the first slab
/// that it has a particle in. Rows are short: nearly all reach no farther than the slab behind.
/// Those of every second slab so have no particle in common, and are swept at the same time; then
/// those of the slabs between; last, or first on the way back, one by one the few that are longer.
template <class Real>
class RowSlabs {
 public:
  /// Few enough that a slab of a pile of some thousand particles is wider than its rows are long.
  static constexpr std::size_t kSlabs = 8;
  /// Lists of rows: one for each slab, and one of long rows.
  static constexpr std::size_t kLists = kSlabs + 1;

  /// Cuts space anew, across its longest extent. Rows that were added before have to be added anew.
  /// @param particles  where rows may be
  /// @param x          positions of all particles, also of others [m]
  void cut(const std::vector<Index>& particles, const QuadArray<Real>& x);

  /// Forgets all rows.
  void clear();
  /// Adds a row at the end of its list, as one that is busy. @return number of the list
  std::size_t add(Index row, const std::array<Index, 4>& particles) {
    const std::uint8_t list = list_of(particles);
    rows_[list].push_back(row);
    busy_[list].push_back(row);
    ++busy_count_;
    ++changes_[list];
    return list;
  }
  /// Chooses the busy rows, which alone are visited: those for which is_busy(row) is true, which
  /// may change what belongs to the row.
  template <class IsBusy>
  void choose(Executor* executor, IsBusy&& is_busy);

  /// Whether no row is busy.
  bool empty() const { return busy_count_ == 0; }
  /// How many are busy.
  std::size_t size() const { return busy_count_; }
  /// Whether so few are that other threads are no help.
  bool are_few() const { return busy_count_ < kFewRows; }
  /// The busy rows of a list, of kLists.
  const std::vector<Index>& list(std::size_t number) const {
    assert(number < kLists);
    return busy_[number];
  }
  /// How often the busy rows of a list have changed, by their numbers or what these stand for.
  std::uint64_t changes(std::size_t number) const { return changes_[number]; }

  /// Calls visit(row) for each busy row, which may change what belongs to the row and its
  /// particles, and returns a number; in the order in which rows were added to their slabs.
  /// @param executor  does what it does on its threads if that is worth while; may be null
  /// @return largest of these numbers, and 0
  template <class Visit>
  Real largest(Executor* executor, Visit&& visit);

  /// Lists a particle that rows have, once.
  void add_particle(Index particle) {
    assert(slab_of_.empty() || at_index(particle) < slab_of_.size());
    particles_[slab_of_.empty() ? 0 : slab_of_[at_index(particle)]].push_back(particle);
    ++particle_count_;
  }
  void clear_particles();
  /// How many particles are listed.
  std::size_t particles() const { return particle_count_; }

  /// Calls visit(particle) for each particle that is listed, which may change what belongs to it.
  template <class Visit>
  void visit_particles(Executor* executor, Visit&& visit) const {
    run_chunks(particle_count_ < kFewParticles ? nullptr : executor, static_cast<int>(kSlabs),
               [&](int slab) {
                 for (const Index i : particles_[at_index(slab)]) visit(i);
               });
  }

 private:
  /// With fewer rows or particles threads take longer to meet than to visit them.
  static constexpr std::size_t kFewRows = 600, kFewParticles = 16384;

  /// The list that a row belongs to.
  std::uint8_t list_of(const std::array<Index, 4>& particles) const;

  std::vector<std::uint8_t> slab_of_;                   ///< each particle
  std::array<std::vector<Index>, kLists> rows_, busy_;  ///< of each slab; last the long ones
  std::array<std::vector<Real>, 3> samples_;            ///< of positions, along each axis [m]
  std::size_t busy_count_ = 0;
  std::array<std::uint64_t, kLists> changes_{};
  std::array<std::vector<Index>, kSlabs> particles_;  ///< by the slab that they were in when listed
  std::size_t particle_count_ = 0;
};

template <class Real>
template <class IsBusy>
void RowSlabs<Real>::choose(Executor* executor, IsBusy&& is_busy) {
  std::size_t rows = 0;
  for (const std::vector<Index>& list : rows_) rows += list.size();
  run_chunks(rows < kFewRows ? nullptr : executor, static_cast<int>(kLists), [&](int chunk) {
    const auto list = static_cast<std::size_t>(chunk);
    std::vector<Index>& busy = busy_[list];
    const std::size_t before = busy.size();
    busy.resize(rows_[list].size());
    std::size_t count = 0;
    bool as_before = true;
    for (const Index row : rows_[list]) {
      if (!is_busy(row)) continue;
      as_before = as_before && count < before && busy[count] == row;
      busy[count++] = row;
    }
    busy.resize(count);
    if (!as_before || count != before) ++changes_[list];
  });
  busy_count_ = 0;
  for (const std::vector<Index>& list : busy_) busy_count_ += list.size();
}

template <class Real>
template <class Visit>
Real RowSlabs<Real>::largest(Executor* executor, Visit&& visit) {
  std::array<Real, kLists> of_list{};
  for_every_second<kLists>(are_few() ? nullptr : executor, true, [&](std::size_t list) {
    Real most = 0;
    for (const Index row : busy_[list]) most = std::max(most, visit(row));
    of_list[list] = most;
  });
  return *std::max_element(of_list.begin(), of_list.end());
}

extern template class RowSlabs<float>;
extern template class RowSlabs<double>;

}  // namespace weft
