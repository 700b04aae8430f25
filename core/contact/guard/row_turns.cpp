// Turns rows with their features, and passes impulses on to the rows that follow.

#include "core/contact/guard/row_turns.h"

#include <algorithm>
#include <utility>

#include "core/contact/guard/constants.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Turns one row. What two edges nearest at an end push is left to the particle there.
template <class Real>
void turn(const RowSource<Real>& source, const PairSeparation<Real>& s, GuardRow<Real>& row) {
  if (!(s.gap > 0)) return;
  const Quad<Real> slipped = row.slip + (weighted(row, source.x) - row.apart);
  if ((kind_of(row) == PairKind::edge_edge && !s.inside) ||
      !weigh(source.state.inverse_mass, s, row)) {
    row.push = 0;
    row.slip = {};
    return;
  }
  row.drag = tangential(row, row.drag);
  row.slip = tangential(row, slipped);
  row.apart = weighted(row, source.x);
}

/// Turns the busy rows of a list.
template <class Real>
void turn_list(const RowSource<Real>& source, const std::vector<Index>& list, RowPart<Real>& part,
               std::vector<GuardRow<Real>>& rows) {
  for (const Index k : list) {
    const GuardRow<Real>& row = rows[static_cast<std::size_t>(k)];
    if (row.push > 0) part.columns[kind_of(row)].add(k, 0, row.particle);
  }
  for (PairColumns<Real>& columns : part.columns) {
    separate_pairs(source.x, source.x, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      GuardRow<Real>& row = rows[static_cast<std::size_t>(columns.a[k])];
      const PairSeparation<Real> s = columns.separation(k, source.x);
      turn(source, s, row);
      if (columns.kind == PairKind::edge_edge || s.inside) continue;
      // A particle that has passed over a border is carried by the triangle beyond, and by none
      // that tilts.
      if (!owns_nearest(source.cloths, source.x, triangle_of(row), row.particle, s))
        part.passed.push_back(row.particle[0]);
    }
  }
}

/// The row that was there before: of the same pair or, where a particle has passed over the border
/// of a triangle, of the same particle in nearly the same direction. Null if there was none.
template <class Real>
GuardRow<Real>* row_before(const GuardRow<Real>& row, RowMaking<Real>& making) {
  const auto& keys = making.old_keys;
  const auto from = [&](std::uint64_t key) {
    return std::lower_bound(keys.begin(), keys.end(), std::pair<std::uint64_t, Index>{key, 0});
  };
  const auto at = [&](auto found) {
    return &making.old_rows[static_cast<std::size_t>(found->second)];
  };
  const auto same = from(row.key);
  if (same != keys.end() && same->first == row.key) return at(same);
  if (kind_of(row) == PairKind::edge_edge) return nullptr;
  const std::uint64_t particle = row.key >> 31;
  for (auto found = from(particle << 31); found != keys.end() && found->first >> 31 == particle;
       ++found) {
    if (dot(at(found)->normal, row.normal) > static_cast<Real>(kSameWay)) return at(found);
  }
  return nullptr;
}

}  // namespace

template <class Real>
void turn_rows(const RowSource<Real>& source, RowMaking<Real>& making, RowSet<Real>& rows,
               Executor* executor, Profile& profile) {
  assert(rows.in_slabs);
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  constexpr std::size_t kLists = RowSlabs<Real>::kLists;
  run_chunks(rows.slabs.are_few() ? nullptr : executor, static_cast<int>(kLists), [&](int chunk) {
    const auto list = static_cast<std::size_t>(chunk);
    turn_list(source, rows.slabs.list(list), making.parts[list], rows.all);
  });
  for (std::size_t list = 0; list < kLists; ++list) {
    RowPart<Real>& part = making.parts[list];
    making.passed.insert(making.passed.end(), part.passed.begin(), part.passed.end());
    part.passed.clear();
    for (PairColumns<Real>& columns : part.columns) {
      profile[Stage::narrow_phase].work += columns.size();
      columns.clear();
    }
  }
}

template <class Real>
void remember(const QuadArray<Real>& x, RowMaking<Real>& making, GuardRow<Real>& row) {
  GuardRow<Real>* old = row_before(row, making);
  if (!old) return;
  row.push = std::exchange(old->push, Real(0));
  row.drag = tangential(row, std::exchange(old->drag, {}));
  // What it slipped since it was last aimed counts too.
  const Quad<Real> apart = weighted(*old, x);
  row.slip = tangential(row, std::exchange(old->slip, {}) + (apart - old->apart));
  old->apart = apart;
}

WEFT_INSTANTIATE_FUNCTIONS(turn_rows, remember)

}  // namespace weft
