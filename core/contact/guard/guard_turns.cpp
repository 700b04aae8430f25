// How the rows of ClothGuard turn with their features, and go on from those before.

#include <algorithm>
#include <utility>

#include "core/contact/guard/cloth_guard.h"

namespace weft {
namespace {

/// A particle that goes over the border of a triangle takes its impulses along if the directions
/// are so much alike: cosine between them.
constexpr double kSameWay = 0.99;

}  // namespace

/// Direction and weights of a row.
/// @return whether anybody can move in it
template <class Real>
bool ClothGuard<Real>::weigh(const ClothState<Real>& state, const PairSeparation<Real>& s,
                             GuardRow<Real>& row) const {
  Real mobility = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    row.weight[k] = s.weight[k];
    row.share[k] = s.weight[k] * state.inverse_mass[static_cast<std::size_t>(row.particle[k])];
    mobility += row.share[k] * row.weight[k];
  }
  row.inertia = mobility > 0 ? 1 / mobility : Real(0);
  row.normal = to_quad(s.normal);
  return mobility > 0;
}

/// Turns the rows that push with their features. Frozen until rows are built anew they jump there,
/// and what rests on them never comes to rest.
template <class Real>
void ClothGuard<Real>::turn_rows(const ClothState<Real>& state, Profile& profile) {
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  run_chunks(row_slabs_.are_few() ? nullptr : executor_, static_cast<int>(turn_parts_.size()),
             [&](int list) { turn_rows(state, static_cast<std::size_t>(list)); });
  for (TurnPart<Real>& part : turn_parts_) {
    passed_.insert(passed_.end(), part.passed.begin(), part.passed.end());
    part.passed.clear();
    for (PairColumns<Real>& columns : part.columns) {
      profile[Stage::narrow_phase].work += columns.size();
      columns.clear();
    }
  }
}

/// Turns the rows of a list.
template <class Real>
void ClothGuard<Real>::turn_rows(const ClothState<Real>& state, std::size_t list) {
  TurnPart<Real>& part = turn_parts_[list];
  for (const Index k : row_slabs_.list(list)) {
    const GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    if (row.push > 0) part.columns[kind_of(row)].add(k, 0, row.particle);
  }
  for (PairColumns<Real>& columns : part.columns) {
    separate_pairs(legal_, legal_, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      GuardRow<Real>& row = rows_[static_cast<std::size_t>(columns.a[k])];
      const PairSeparation<Real> s = columns.separation(k, legal_);
      turn(state, s, row);
      if (columns.kind == PairKind::edge_edge || s.inside) continue;
      // Who has gone over a border is carried by the triangle beyond, and by none that tilts.
      if (!owns_nearest(triangle_of(row), row.particle, s)) part.passed.push_back(row.particle[0]);
    }
  }
}

template <class Real>
void ClothGuard<Real>::turn(const ClothState<Real>& state, const PairSeparation<Real>& s,
                            GuardRow<Real>& row) const {
  if (!(s.gap > 0)) return;
  const Quad<Real> slipped = row.slip + (weighted(row, legal_) - row.apart);
  // Edges that are nearest at an end leave it to the particle there.
  if ((kind_of(row) == PairKind::edge_edge && !s.inside) || !weigh(state, s, row)) {
    row.push = 0;
    row.slip = {};
    return;
  }
  row.drag = tangential(row, row.drag);
  row.slip = tangential(row, slipped);
  row.apart = weighted(row, legal_);
}

/// The row that was there before: of the same pair or, where a particle went over the border of a
/// triangle, of the same particle in nearly the same direction. Null if there was none.
template <class Real>
GuardRow<Real>* ClothGuard<Real>::row_before(const GuardRow<Real>& row) {
  const auto from = [&](std::uint64_t key) {
    return std::lower_bound(old_keys_.begin(), old_keys_.end(),
                            std::pair<std::uint64_t, Index>{key, 0});
  };
  const auto at = [&](auto found) { return &old_rows_[static_cast<std::size_t>(found->second)]; };
  const auto same = from(row.key);
  if (same != old_keys_.end() && same->first == row.key) return at(same);
  if (kind_of(row) == PairKind::edge_edge) return nullptr;
  const std::uint64_t particle = row.key >> 31;
  for (auto found = from(particle << 31);
       found != old_keys_.end() && found->first >> 31 == particle; ++found) {
    if (dot(at(found)->normal, row.normal) > static_cast<Real>(kSameWay)) return at(found);
  }
  return nullptr;
}

/// Goes on with the impulses and the anchor of the row before, which are given once.
template <class Real>
void ClothGuard<Real>::remember(GuardRow<Real>& row) {
  GuardRow<Real>* old = row_before(row);
  if (!old) return;
  row.push = std::exchange(old->push, Real(0));
  row.drag = tangential(row, std::exchange(old->drag, {}));
  // What it slipped since it was last aimed counts too.
  const Quad<Real> apart = weighted(*old, legal_);
  row.slip = tangential(row, std::exchange(old->slip, {}) + (apart - old->apart));
  old->apart = apart;
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template bool ClothGuard<Real>::weigh(const ClothState<Real>&, const PairSeparation<Real>&, \
                                        GuardRow<Real>&) const;                               \
  template void ClothGuard<Real>::turn_rows(const ClothState<Real>&, Profile&);               \
  template void ClothGuard<Real>::turn_rows(const ClothState<Real>&, std::size_t);            \
  template void ClothGuard<Real>::turn(const ClothState<Real>&, const PairSeparation<Real>&,  \
                                       GuardRow<Real>&) const;                                \
  template GuardRow<Real>* ClothGuard<Real>::row_before(const GuardRow<Real>&);               \
  template void ClothGuard<Real>::remember(GuardRow<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
