// The regions of ClothGuard: balls around anchors in which particles are free.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/guard/cloth_guard.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// A bound of a gap is measured anew unless it leaves a particle room for so many of its steps.
constexpr double kStepsOfRoom = 16;

/// More waves of anchoring than ever seen; then all is measured anew.
constexpr int kMostWaves = 48;

/// Speed that both sides of a pair are given beside their own when they share a gap, as a part of
/// the faster one's.
constexpr double kLeastShare = 0.08;

/// Each side gets at least this part of a gap.
constexpr double kLeastOfGap = kLeastShare / (1 + 2 * kLeastShare) * 0.999;

/// Part of the reach beyond which a particle is given a new path with those that have left theirs.
constexpr double kSoon = 0.6;

/// Particles are anchored in parts with at least so many.
constexpr std::size_t kAnchoredAtLeast = 8;

}  // namespace

/// How far everybody in a pair wants to move in the coming step.
template <class Real>
void ClothGuard<Real>::measure_steps() {
  if (std::exchange(measured_steps_, substep_) == substep_) return;
  for (std::size_t i = 0; i < step_.size(); ++i) step_length_[i] = length(step_[i]);
}

/// How far the sides of a pair want to move in the coming step, both a little.
template <class Real>
typename ClothGuard<Real>::Speeds ClothGuard<Real>::speeds(const GuardedPair<Real>& pair) const {
  Real side[2] = {0, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    Real& most = side[k < first_side(pair.kind) ? 0 : 1];
    most = std::max(most, step_length_[static_cast<std::size_t>(pair.particle[k])]);
  }
  const Real both = std::max(side[0], side[1]) * Real(kLeastShare) + Real(1e-9);
  return {side[0] + both, side[1] + both};
}

/// Tells how far everybody wants to move in the coming step. Lists the particles that leave the
/// balls around their predicted paths in it, and with them those that soon will. What all leave
/// their paths by in common changes nothing between them, and is told from the step before.
template <class Real>
void ClothGuard<Real>::find_strays(const ClothState<Real>& state, Real dt) {
  const Real limit = reach_ * reach_, soon = limit * static_cast<Real>(kSoon * kSoon);
  bool left = false;
  Real spare2 = limit;
  strays_.clear();
  const auto look = [&](std::size_t i) {
    step_[i] = (to_quad(state.x[i]) - legal_[i]) + to_quad(state.v[i]) * dt;
    const Quad<Real> off = legal_[i] + step_[i] - on_path(i, elapsed_), own = off - off_path_;
    const Real off2 = dot(own, own);
    spare2 = std::min(spare2, limit - off2);
    if (!(off2 <= soon)) {
      strays_.push_back(static_cast<Index>(i));
      left |= !(off2 <= limit);
    }
    return off;
  };
  Quad<Real> sum;
  std::size_t i = 0;
  for (const IndexRange& range : awake_) {
    for (; i < static_cast<std::size_t>(range.first); ++i) look(i);
    for (; i < static_cast<std::size_t>(range.end()); ++i) sum += look(i);
  }
  for (; i < step_.size(); ++i) look(i);
  // a - b >= (a^2 - b^2) / 2a for 0 <= b <= a.
  leeway_ = spare2 / (2 * reach_);
  const bool collected = collected_ && elapsed_ <= horizon_;
  if (!left || !collected) strays_.clear();
  if (!collected) return;
  off_path_before_ = off_path_now_;
  off_path_now_ = off_path_;
  off_path_ = sum * (Real(1) / static_cast<Real>(std::max<std::size_t>(awake_count_, 1)));
}

/// Particles that would leave the room around their anchors.
template <class Real>
void ClothGuard<Real>::find_loose() {
  loose_.clear();
  ++wave_;
  for (const Index i : dirty_) wave_of_[static_cast<std::size_t>(i)] = wave_;
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    const Quad<Real> off = legal_[i] + step_[i] - anchor_[i];
    const Real spare2 = room_[i] * room_[i] - dot(off, off);
    if (wave_of_[i] == wave_ || !(spare2 >= 0)) loose_.push_back(k);
    leeway_ = room_[i] > 0 ? std::min(leeway_, spare2 / (2 * room_[i])) : Real(0);
  }
  dirty_.clear();
}

template <class Real>
void ClothGuard<Real>::measure(GuardedPair<Real>& pair) {
  pair.bound = separate_pair(pair.kind, points(pair, anchor_)).gap;
}

/// Anchors particles where they are, and gives them room anew. Who is in their way with more room
/// than the gap now has is anchored anew as well.
template <class Real>
void ClothGuard<Real>::anchor(const std::vector<Index>& list) {
  measure_steps();
  wave_list_ = list;
  for (int wave = 0; !wave_list_.empty(); ++wave) {
    stop_point();
    if (wave == kMostWaves) {
      anchor_all();
      return;
    }
    next_.clear();
    ++wave_;
    anchor_wave(wave == 0);
    std::sort(next_.begin(), next_.end());
    next_.erase(std::unique(next_.begin(), next_.end()), next_.end());
    wave_list_ = next_;
  }
}

template <class Real>
void ClothGuard<Real>::anchor_wave(bool first) {
  for (const Index k : wave_list_) {
    const auto i = static_cast<std::size_t>(k);
    wave_of_[i] = wave_;
    room_[i] = 0;
    if (anchored_at_[i] == substep_) continue;
    anchored_at_[i] = substep_;
    anchored_.push_back(k);
    ++counts_.anchored;
    // The bound of a gap falls by no more than what an anchor moves.
    const Real moved = length(legal_[i] - anchor_[i]);
    anchor_[i] = legal_[i];
    if (moved == 0) continue;
    for_pairs_of(i, [&](GuardedPair<Real>& pair) { pair.bound -= moved; });
  }
  const std::size_t count = wave_list_.size(), parts = parts_of(count, kAnchoredAtLeast);
  run_parts(executor_, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    AnchorPart<Real>& part = anchor_parts_[n];
    part.claims.clear();
    for (std::size_t k = from; k < to; ++k) list_claims(wave_list_[k], part);
    measure_claimed(part);
  });
  run_parts(executor_, count, parts, [&](std::size_t n, std::size_t, std::size_t) {
    for (PairColumns<Real>& columns : anchor_parts_[n].columns) {
      for (std::size_t k = 0; k < columns.size(); ++k)
        pairs_[static_cast<std::size_t>(columns.a[k])].bound = columns.gap[k];
      columns.clear();
    }
  });
  run_parts(executor_, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    AnchorPart<Real>& part = anchor_parts_[n];
    auto claim = part.claims.begin();
    for (std::size_t k = from; k < to; ++k) {
      const auto begin = claim;
      while (claim != part.claims.end() && claim->particle == wave_list_[k]) ++claim;
      room_[static_cast<std::size_t>(wave_list_[k])] = share_claims({begin, claim}, first, part);
    }
  });
  for (std::size_t n = 0; n < parts; ++n) {
    std::vector<Index>& next = anchor_parts_[n].next;
    next_.insert(next_.end(), next.begin(), next.end());
    next.clear();
  }
}

/// Lists the pairs of a particle with the rooms that others have in them, and for measuring those
/// whose bound may not be enough for one who is being anchored: the first of these in the pair asks
/// for all.
template <class Real>
void ClothGuard<Real>::list_claims(Index particle, AnchorPart<Real>& part) {
  const auto ahead_of = [this](std::size_t j) {
    return step_length_[j] * Real(2 * kStepsOfRoom) + smallest_gap_;
  };
  for_pairs_of(static_cast<std::size_t>(particle), [&](const GuardedPair<Real>& pair) {
    const std::size_t middle = first_side(pair.kind);
    Real rooms[2] = {0, 0}, ahead[2] = {-1, -1};
    Index first = kNone;
    std::size_t at = 0;
    for (std::size_t m = 0; m < 4; ++m) {
      const auto j = static_cast<std::size_t>(pair.particle[m]);
      const std::size_t side = m < middle ? 0 : 1;
      if (wave_of_[j] != wave_) {
        rooms[side] = std::max(rooms[side], room_[j]);
        continue;
      }
      if (first == kNone) first = pair.particle[m];
      if (pair.particle[m] == particle) at = side;
      ahead[side] = std::max(ahead[side], ahead_of(j));
    }
    const auto is_ample = [&](std::size_t side, Real way) {
      return pair.bound > std::max(rooms[0], rooms[1]) + rooms[1 - side] + way;
    };
    const bool ample = is_ample(at, ahead_of(static_cast<std::size_t>(particle)));
    part.claims.push_back({static_cast<Index>(&pair - pairs_.data()), particle, rooms[at],
                           rooms[1 - at], at == 0, ample});
    if (first != particle) return;
    const auto wants = [&](std::size_t side) {
      return ahead[side] >= 0 && !is_ample(side, ahead[side]);
    };
    if (!wants(0) && !wants(1)) return;
    part.columns[pair.kind].add(part.claims.back().pair, 0, pair.particle);
  });
}

/// Measures the gaps of the pairs in the columns.
template <class Real>
void ClothGuard<Real>::measure_claimed(AnchorPart<Real>& part) const {
  for (PairColumns<Real>& columns : part.columns) {
    separate_pairs(anchor_, anchor_, columns);
    for (std::size_t k = 0; k < columns.size(); ++k)
      columns.gap[k] = columns.certified_gap(k, anchor_);
  }
}

/// The room that all pairs leave a particle: its side's share of the gap, and no more than what the
/// other side has not taken. Lists who has taken too much.
/// @param claims  all of one particle
template <class Real>
Real ClothGuard<Real>::share_claims(std::span<const AnchorClaim<Real>> claims, bool first,
                                    AnchorPart<Real>& part) const {
  Real room = std::numeric_limits<Real>::infinity();
  for (const AnchorClaim<Real>& claim : claims) {
    const GuardedPair<Real>& pair = pairs_[static_cast<std::size_t>(claim.pair)];
    const Real gap = std::max(Real(0), pair.bound - smallest_gap_);
    // What is far apart, even if its side gets the least share, changes nothing.
    if (claim.ample && gap * Real(kLeastOfGap) >= room) continue;
    const Speeds speed = speeds(pair);
    const Real share =
        gap * ((claim.on_first ? speed.first : speed.second) / (speed.first + speed.second));
    const Real left = gap - claim.other;
    room = std::min(room, std::max(Real(0), std::min(share, left)));
    // The others' rooms alone are too much for the gap, or they leave less than the next steps
    // need.
    const Real step = step_length_[static_cast<std::size_t>(claim.particle)];
    const bool too_much = claim.own + claim.other > gap;
    const bool greedy = first && left < share && left < 2 * step;
    if (!too_much && !greedy) continue;
    for (const Index j : pair.particle) {
      if (wave_of_[static_cast<std::size_t>(j)] != wave_ &&
          (room_[static_cast<std::size_t>(j)] > 0 || greedy))
        part.next.push_back(j);
    }
    part.next.push_back(claim.particle);
  }
  return room;
}

/// Anchors and measures everything.
template <class Real>
void ClothGuard<Real>::anchor_all() {
  ++wave_;
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    if (anchored_at_[i] != substep_) anchored_.push_back(k);
    anchored_at_[i] = substep_;
    anchor_[i] = legal_[i];
  }
  for (GuardedPair<Real>& pair : pairs_) {
    if (!pair.open && !pair.gone) measure(pair);
  }
  share_all_gaps();
}

#define WEFT_INSTANTIATE(Real)                                                                  \
  template void ClothGuard<Real>::measure_steps();                                              \
  template typename ClothGuard<Real>::Speeds ClothGuard<Real>::speeds(const GuardedPair<Real>&) \
      const;                                                                                    \
  template void ClothGuard<Real>::find_strays(const ClothState<Real>&, Real);                   \
  template void ClothGuard<Real>::find_loose();                                                 \
  template void ClothGuard<Real>::measure(GuardedPair<Real>&);                                  \
  template void ClothGuard<Real>::anchor(const std::vector<Index>&);                            \
  template void ClothGuard<Real>::anchor_wave(bool);                                            \
  template void ClothGuard<Real>::list_claims(Index, AnchorPart<Real>&);                        \
  template void ClothGuard<Real>::measure_claimed(AnchorPart<Real>&) const;                     \
  template Real ClothGuard<Real>::share_claims(std::span<const AnchorClaim<Real>>, bool,        \
                                               AnchorPart<Real>&) const;                        \
  template void ClothGuard<Real>::anchor_all();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
