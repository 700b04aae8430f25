// Keeps rows with their particles.

#include "core/contact/guard/row_set.h"

#include <cassert>
#include <utility>

#include "core/instantiate.h"

namespace weft {

template <class Real>
RowSet<Real> row_set(std::size_t particles) {
  RowSet<Real> rows;
  rows.first.assign(particles, kNone);
  rows.has_particle.assign(particles, 0);
  rows.pressure.assign(particles, Real(0));
  return rows;
}

template <class Real>
void forget_rows(RowSet<Real>& rows) {
  rows.all.clear();
  rows.slabs.clear();
  rows.deals.clear();
}

template <class Real>
void list_row(std::size_t r, RowSet<Real>& rows) {
  assert(r == rows.next.size() && r < rows.all.size());
  const GuardRow<Real>& row = rows.all[r];
  Index& last = rows.first[at_index(row.particle[0])];
  rows.next.push_back(std::exchange(last, static_cast<Index>(r)));
  for (const Index i : row.particle) {
    if (std::exchange(rows.has_particle[at_index(i)], 1)) continue;
    rows.slabs.add_particle(i);
    rows.pressure[at_index(i)] = 0;
  }
}

template <class Real>
void add_row(const GuardRow<Real>& row, RowSet<Real>& rows) {
  assert(row.inertia > 0);
  rows.all.push_back(row);
  list_row(rows.all.size() - 1, rows);
}

template <class Real>
bool has_row(const RowSet<Real>& rows, Index first, std::uint64_t key) {
  Index r = rows.first[at_index(first)];
  assert(r == kNone || at_index(r) < rows.all.size());
  while (r != kNone && rows.all[at_index(r)].key != key) r = rows.next[at_index(r)];
  return r != kNone;
}

WEFT_INSTANTIATE_FUNCTIONS(row_set, forget_rows, list_row, add_row, has_row)

}  // namespace weft
