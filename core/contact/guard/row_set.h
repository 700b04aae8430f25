#pragma once

#include <cstdint>
#include <vector>

#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/row_deals.h"
#include "core/contact/guard/row_slabs.h"
#include "core/types.h"

// The rows of near pairs, and where they stand.

namespace weft {

/// All rows. Those that push or soon may are busy: they stand in slabs, and between two looks in
/// blocks, which are what responds.
template <class Real>
struct RowSet {
  std::vector<GuardRow<Real>> all;
  std::vector<Index> first;        ///< of each particle the last row whose first one it is
  std::vector<Index> next;         ///< of each row the one before with the same first particle
  std::vector<char> has_particle;  ///< of each particle, whether any row has it
  RowSlabs<Real> slabs;
  bool in_slabs = false;       ///< all rows stand in these
  RowDeals<Real> deals;        ///< busy rows in blocks
  std::vector<Real> pressure;  ///< about particles in rows, at the last look [Pa]
  Real most_pressure = 0;      ///< of these [Pa]
};

/// Rows of no particle.
/// @param particles  number of all
template <class Real>
RowSet<Real> row_set(std::size_t particles);

/// Forgets all rows. `first` and the particle lists stay until rows are made anew; has_row must not
/// be called before.
template <class Real>
void forget_rows(RowSet<Real>& rows);

/// Keeps the rows for which keeps(row) is true, in their order, and lists no other particles.
template <class Real, class Keeps>
void keep_rows(RowSet<Real>& rows, Keeps&& keeps);

/// Adds a row and lists its particles.
template <class Real>
void add_row(const GuardRow<Real>& row, RowSet<Real>& rows);

/// Whether a pair has a row.
/// @param first  its first particle
template <class Real>
bool has_row(const RowSet<Real>& rows, Index first, std::uint64_t key);

// ---- implementation ----

/// Lists row number r with its first particle, and its particles.
template <class Real>
void list_row(std::size_t r, RowSet<Real>& rows);

template <class Real, class Keeps>
void keep_rows(RowSet<Real>& rows, Keeps&& keeps) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows.all.size(); ++k) {
    if (!keeps(rows.all[k])) continue;
    if (kept != k) rows.all[kept] = rows.all[k];
    ++kept;
  }
  rows.all.resize(kept);
  rows.slabs.visit_particles(nullptr, [&](Index k) {
    const auto i = at_index(k);
    rows.has_particle[i] = 0;
    rows.first[i] = kNone;
  });
  rows.slabs.clear_particles();
  rows.next.clear();
  for (std::size_t r = 0; r < rows.all.size(); ++r) list_row(r, rows);
}

}  // namespace weft
