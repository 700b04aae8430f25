// Finds the pairs that are near enough for a row, and makes these rows.

#include "core/contact/guard/row_making.h"

#include <algorithm>
#include <cassert>

#include "core/contact/guard/carrying_pairs.h"
#include "core/contact/guard/constants.h"
#include "core/contact/parts.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Sets the direction and weights of a row from the separation of its features.
/// @return whether any of its particles can move in it
template <class Real>
bool weigh(const std::vector<Real>& inverse_mass, const PairSeparation<Real>& s,
           GuardRow<Real>& row) {
  Real mobility = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    row.weight[k] = s.weight[k];
    row.share[k] = s.weight[k] * inverse_mass[at_index(row.particle[k])];
    mobility += row.share[k] * row.weight[k];
  }
  assert(!(mobility < 0));
  row.inertia = mobility > 0 ? 1 / mobility : Real(0);
  row.normal = to_quad(s.normal);
  return mobility > 0;
}

/// The first of the jammed pairs that does not come before a key.
auto first_jammed(auto& jammed, std::uint64_t key) {
  return std::lower_bound(
      jammed.begin(), jammed.end(), key,
      [](const JammedPair& pair, std::uint64_t wanted) { return pair.key < wanted; });
}

/// Whether a pair is jammed, by its key.
template <class Real>
bool is_jammed(const RowSource<Real>& source, std::uint64_t key) {
  if (source.jammed.empty()) return false;  // as nearly always
  const auto found = first_jammed(source.jammed, key);
  return found != source.jammed.end() && found->key == key;
}

/// Turns one row. What edges push that do not carry each other is left to what is nearer.
template <class Real>
void turn(const RowSource<Real>& source, const PairSeparation<Real>& s, GuardRow<Real>& row) {
  if (!(s.gap > 0)) return;
  const Quad<Real> slipped = row.slip + (weighted(row, source.x) - row.apart);
  if ((kind_of(row) == PairKind::edge_edge &&
       !edges_carry(source.cloths, source.x, row.particle, s, [] { return true; }) &&
       !is_jammed(source, row.key)) ||
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
    const GuardRow<Real>& row = rows[at_index(k)];
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
      if (!own_nearest(source.cloths, source.x, triangle_of(row), row.particle, s, true) &&
          !is_jammed(source, row.key))
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
  const auto at = [&](auto found) { return &making.old_rows[at_index(found->second)]; };
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

/// Goes on with the impulses and the anchor of the row before, which are passed on once.
/// @param x  positions [m]
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

/// Whether the gap that a pair had, less what its particles have moved since, is too much for a
/// row.
template <class Real>
bool is_beyond(const GuardedPair<Real>& pair, const std::vector<Real>& off_anchor, Real most) {
  const auto [first, second] = largest_on_sides(pair, [&](std::size_t i) { return off_anchor[i]; });
  return pair.bound - first - second > most;
}

/// Whether a pair had a row that pushed, and was dropped to be made anew.
template <class Real>
bool has_pushed(const RowMaking<Real>& making, std::uint64_t key) {
  const auto& keys = making.old_keys;
  const auto found =
      std::lower_bound(keys.begin(), keys.end(), std::pair<std::uint64_t, Index>{key, 0});
  return found != keys.end() && found->first == key &&
         making.old_rows[at_index(found->second)].push > 0;
}

/// Makes a row. @return whether the pair is near enough for one, and no other pair's to respond
template <class Real>
bool make_row(const RowSource<Real>& source, const RowMaking<Real>& making,
              const GuardedPair<Real>& pair, const PairSeparation<Real>& s, GuardRow<Real>& row) {
  const GuardedCloths<Real>& cloths = source.cloths;
  if (s.gap > cloths.thickest * Real(kRowReach) || !(s.gap > 0)) return false;
  const auto pushes = [&] {
    return has_pushed(making, key_of(pair)) && !is_jammed(source, key_of(pair));
  };
  const bool passes = !carries(cloths, source.x, pair, s, pushes);
  if (passes && !is_jammed(source, key_of(pair))) return false;
  Real approach = 0;
  for (std::size_t k = 0; k < 4; ++k)
    approach -= s.weight[k] * s.normal.dot(source.state.v[at_index(pair.particle[k])]);
  const Real soon = std::max(Real(0), approach) * Real(2 * kLongestRows);
  const Real margin = std::max(cloths.thickest * Real(kRowMargin), soon);
  if (s.gap > cloths.thickest + margin) return false;
  const Index p = cloth_of(cloths, pair.particle[0]), q = cloth_of(cloths, pair.particle[2]);
  row.radius = kept_distance(cloths, pair, p, q);
  if (passes) row.radius = std::max(row.radius * Real(kJammedPart), source.smallest_gap * 2);
  if (s.gap > row.radius + margin) return false;
  row.particle = pair.particle;
  if (!weigh(source.state.inverse_mass, s, row)) return false;
  row.friction = (cloths.friction[at_index(p)] + cloths.friction[at_index(q)]) / 2;
  row.key = key_of(pair);
  row.apart = weighted(row, source.x);
  return true;
}

/// Makes the rows of the pairs in the columns.
template <class Real>
void make_near_rows(const RowSource<Real>& source, const RowMaking<Real>& making,
                    const GuardedPairs<Real>& pairs, RowPart<Real>& part) {
  for (PairColumns<Real>& columns : part.columns) {
    separate_pairs(source.x, source.x, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns.gap[k] > source.cloths.thickest * Real(kRowReach)) continue;
      GuardRow<Real> row;
      if (make_row(source, making, pairs[columns.a[k]], columns.separation(k, source.x), row))
        part.rows[static_cast<std::size_t>(columns.kind)].push_back(row);
    }
  }
}

template <class Real>
bool has_moved(const RowMaking<Real>& making, const std::array<Index, 4>& particles) {
  return std::any_of(particles.begin(), particles.end(),
                     [&](Index i) { return making.is_moved[at_index(i)] != 0; });
}

/// Drops the rows of particles that have moved, and keeps in mind what they pushed.
template <class Real>
void drop_moved_rows(RowMaking<Real>& making, RowSet<Real>& rows) {
  making.old_rows.clear();
  making.old_keys.clear();
  keep_rows(rows, [&](const GuardRow<Real>& row) {
    if (making.made && !has_moved(making, row.particle)) return true;
    if (row.push > 0 || dot(row.slip, row.slip) > 0) {
      making.old_keys.push_back({row.key, static_cast<Index>(making.old_rows.size())});
      making.old_rows.push_back(row);
    }
    return false;
  });
  std::sort(making.old_keys.begin(), making.old_keys.end());
}

/// Lists the pairs of the particles that have moved, each once.
template <class Real>
void list_moved_pairs(GuardedPairs<Real>& pairs, RowMaking<Real>& making) {
  ++pairs.listing;
  for (const Index k : making.moved) {
    for_pairs_of(pairs, at_index(k), [&](GuardedPair<Real>& pair) {
      if (std::exchange(pair.listed, pairs.listing) != pairs.listing)
        making.candidates.push_back(pairs.number_of(pair));
    });
  }
}

/// Adds the rows that all parts made, in their order; they go on from those before.
template <class Real>
void take_over_rows(const QuadArray<Real>& x, std::size_t parts, RowMaking<Real>& making,
                    RowSet<Real>& rows, Profile& profile) {
  for (const PairKind kind : {PairKind::vertex_triangle, PairKind::edge_edge}) {
    for (std::size_t n = 0; n < parts; ++n) {
      PairColumns<Real>& columns = making.parts[n].columns[kind];
      profile[Stage::narrow_phase].work += columns.size();
      columns.clear();
      std::vector<GuardRow<Real>>& made = making.parts[n].rows[static_cast<std::size_t>(kind)];
      for (GuardRow<Real>& row : made) {
        remember(x, making, row);
        add_row(row, rows);
      }
      made.clear();
    }
  }
}

}  // namespace

template <class Real>
RowMaking<Real> row_making(std::size_t particles) {
  RowMaking<Real> making;
  making.x.assign(particles, {});
  making.is_moved.assign(particles, 0);
  making.off_anchor.assign(particles, Real(0));
  making.parts.resize(std::max(kMostParts, RowSlabs<Real>::kLists));
  return making;
}

template <class Real>
void forget_made(RowMaking<Real>& making) {
  making.made = false;
  making.passed.clear();
  making.jammed.clear();
  std::fill(making.is_moved.begin(), making.is_moved.end(), 0);
  for (RowPart<Real>& part : making.parts) {
    part.columns.clear();
    part.passed.clear();
    for (std::vector<GuardRow<Real>>& rows : part.rows) rows.clear();
  }
}

template <class Real>
void place_new_particles(const GuardedPairs<Real>& pairs, std::size_t first,
                         const QuadArray<Real>& x, RowMaking<Real>& making) {
  for_pairs_from(pairs, first, [&](const GuardedPair<Real>& pair) {
    for (const Index k : pair.particle) {
      const auto i = at_index(k);
      if (!pairs.is_active[i]) making.x[i] = x[i];
    }
  });
}

template <class Real>
void note_jammed(const std::vector<JammedPair>& found, RowMaking<Real>& making) {
  for (const JammedPair& pair : found) {
    const auto place = first_jammed(making.jammed, pair.key);
    if (place != making.jammed.end() && place->key == pair.key) continue;
    making.jammed.insert(place, pair);
    making.passed.push_back(pair.first);
  }
}

template <class Real>
bool find_moved(const std::vector<Index>& active, const QuadArray<Real>& x, Real thickest,
                RowMaking<Real>& making) {
  making.moved.clear();
  if (!making.made) {
    making.moved = active;
    making.passed.clear();
    making.time = 0;
    making.steps = 0;
    return true;
  }
  if (!is_time_to_look(making)) return false;
  const bool old = making.time > static_cast<Real>(kLongestRows);
  if (old) making.time = 0;
  const Real most = thickest * static_cast<Real>(old ? kRestMotion : kRowMotion);
  for (const Index k : active) {
    const auto i = at_index(k);
    const Quad<Real> moved = x[i] - making.x[i];
    if (!(dot(moved, moved) <= most * most)) making.moved.push_back(k);
  }
  making.moved.insert(making.moved.end(), making.passed.begin(), making.passed.end());
  making.passed.clear();
  return !making.moved.empty();
}

template <class Real>
void renew_rows(const RowSource<Real>& source, const QuadArray<Real>& anchor,
                GuardedPairs<Real>& pairs, RowMaking<Real>& making, RowSet<Real>& rows,
                Executor* executor, Profile& profile) {
  assert(anchor.size() == source.x.size() && making.x.size() == source.x.size());
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  for (const Index k : making.moved) making.is_moved[at_index(k)] = 1;
  drop_moved_rows(making, rows);
  for (const Index k : pairs.active) {
    const auto i = at_index(k);
    making.off_anchor[i] = length(source.x[i] - anchor[i]);
  }
  making.candidates.clear();
  const bool many = making.moved.size() > pairs.active.size() / kManyMoved;
  if (!many) list_moved_pairs(pairs, making);
  const Real most = source.cloths.thickest * Real(kRowReach);
  const std::size_t count = many ? pairs.all.size() : making.candidates.size();
  const std::size_t parts = parts_of(count, kPairsAtLeast);
  run_parts(executor, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const Index number = many ? static_cast<Index>(k) : making.candidates[k];
      const GuardedPair<Real>& pair = std::as_const(pairs)[number];
      if (many && (pair.open || pair.gone || !has_moved(making, pair.particle))) continue;
      if (is_beyond(pair, making.off_anchor, most)) continue;
      making.parts[n].columns[pair.kind].add(number, 0, pair.particle);
    }
    make_near_rows(source, making, pairs, making.parts[n]);
  });
  for (const Index k : making.moved) {
    const auto i = at_index(k);
    making.is_moved[i] = 0;
    making.x[i] = source.x[i];
  }
  if (!making.made) pairs.arrived.clear();
  making.made = true;
  rows.in_slabs = false;
  take_over_rows(source.x, parts, making, rows, profile);
  std::erase_if(making.jammed,
                [&rows](const JammedPair& pair) { return !has_row(rows, pair.first, pair.key); });
}

template <class Real>
void add_arrived(const RowSource<Real>& source, GuardedPairs<Real>& pairs, RowMaking<Real>& making,
                 RowSet<Real>& rows, Profile& profile) {
  assert(making.made);
  const StageTimer timer(profile, Stage::narrow_phase, pairs.arrived.size());
  for (const GuardedPair<Real>& pair : pairs.arrived) {
    GuardRow<Real> row;
    if (has_row(rows, pair.particle[0], key_of(pair))) continue;
    if (!make_row(source, making, pair, separate_pair(pair.kind, points_of(pair, source.x)), row))
      continue;
    const auto number = static_cast<Index>(rows.all.size());
    const std::size_t list = rows.slabs.add(number, pair.particle);
    remember(source.x, making, row);
    add_row(row, rows);
    rows.deals.add(list, number, rows.all);
  }
  pairs.arrived.clear();
}

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

WEFT_INSTANTIATE_FUNCTIONS(turn_rows, note_jammed, forget_made, row_making, place_new_particles,
                           find_moved, renew_rows, add_arrived)

}  // namespace weft
