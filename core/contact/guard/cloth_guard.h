#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/cloth/neighbours.h"
#include "core/contact/feature_pair.h"
#include "core/contact/guard/guard_pair.h"
#include "core/contact/guard/guard_parts.h"
#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/pair_separation.h"
#include "core/contact/guard/patch_boxes.h"
#include "core/contact/guard/row_deals.h"
#include "core/contact/tangles/cloth_tangles.h"
#include "core/executor.h"
#include "core/profile.h"
// Contact of cloths with themselves and each other; section 4 of core/README.md is an overview.

namespace weft {

/// Keeps particles from passing triangles, and edges from passing edges.
/// Two nested regions keep the work small. All particles stay in balls of `reach` around a
/// predicted straight path: pairs of features whose balls never meet are not looked at. Of the
/// others each pair has a certified gap between the places where its particles were anchored, which
/// the two sides share out as the radii of balls around these anchors: while all stay in their
/// balls, wherever there, nothing has crossed. A particle that is about to leave is anchored anew,
/// and its pairs are measured again. Where there is no room left, the coming step itself is
/// certified: a pair is apart throughout a step on straight lines if one plane has its sides apart
/// at both ends of it. Only a pair for which that fails gets two planes in its gap, and its
/// particles stop at them. A particle that does not move is always allowed.
///
/// A contact solver keeps gaps open, so that the regions seldom have to: rows of near pairs, frozen
/// for some substeps, projected Gauss-Seidel on velocities with Coulomb friction that sticks to
/// anchors.
template <class Real>
class ClothGuard {
 public:
  ClothGuard() = default;
  /// @param executor  works through the search for pairs in chunks; may be null
  explicit ClothGuard(const ClothModel<Real>& model, Executor* executor = nullptr);

  /// Forgets everything about where the cloths are.
  void reset();

  /// Says that masses changed (a pin).
  void invalidate_rows() { rows_built_ = false; }

  /// Says that which cloths sleep has changed: these are not looked at between each other.
  /// @param asleep  of each cloth 1 if it sleeps; empty if none does
  void let_rest(const std::vector<char>& asleep);

  /// Before all other contact: the contact impulses of the last step again. `sweep` mends them.
  void solve(ClothState<Real>& state, Real dt, Profile& profile);

  /// A sweep over the rows, to be called in turn with those of other contact: what rests in layers
  /// on an object is held by both.
  /// @return largest change of a normal velocity [m/s]
  Real sweep(ClothState<Real>& state);

  /// After all sweeps: a push for those that are too near, which moves them in the coming drift
  /// without giving them velocity. No sweep may see it: what holds against the push would become
  /// impulses, and what is squeezed between objects would be pressed harder each step.
  void push_apart(ClothState<Real>& state);

  /// Sweeps and push where the cloths meet nothing else in the coming drift of `dt` [s].
  void respond_alone(ClothState<Real>& state, Real dt);

  /// After all other contact and right before the drift of `dt` [s]: lets nobody leave his region.
  /// Whoever has to stop earlier does so on the straight line of his motion since `solve`.
  void certify(ClothState<Real>& state, Real dt, Profile& profile);

  /// After `certify`: says that all stay where they were instead, off the paths that were expected.
  /// All that they wanted in this step is lost.
  void stand_still() {
    collected_ = false;
    counts_.truncated += allowed_;
  }

  /// After the drift: takes the push out of the velocities again.
  void finish(ClothState<Real>& state);

  /// Paths along which nothing can meet, for steps without the calls above; null if there are none.
  const CalmPaths<Real>* calm_paths() const {
    return collected_ && active_.empty() && open_pairs() == 0 && pushed_.empty() ? &calm_paths_
                                                                                 : nullptr;
  }

  /// Says that steps went by without the calls above.
  /// @param steps   so many
  /// @param time    at their end, as in the calm paths [s]
  /// @param common  by how much all are off their paths then, in common [m]
  /// @param renew   look for other paths in the coming step
  void leave_calm_paths(int steps, Real time, const Vec3<Real>& common, bool renew);

  /// At the end of a tick, whose last kick is half of one: stands against that with half the
  /// impulses. `sweep` makes the velocities admissible.
  void settle(ClothState<Real>& state, Real dt, Profile& profile);

  const GuardCounts& counts() const { return counts_; }
  /// Those that are not `gone`: all whose features come nearer than twice the reach while all
  /// particles go along their predicted paths.
  const std::vector<GuardedPair<Real>>& pairs() const { return pairs_; }
  /// Where a particle's predicted path is after the last step [m].
  Vec3<Real> predicted(std::size_t particle) const {
    return to_vector(on_path(particle, elapsed_));
  }
  Real reach() const { return reach_; }
  /// At the end of a tick.
  const std::vector<GuardRow<Real>>& rows() const { return rows_; }
  /// Whether any cloth pressed against itself or another in the last step.
  bool presses() const { return row_deals_.pushes(); }
  /// Time of the forces that the rows' impulses stand against [s].
  Real kicked() const { return kicked_; }
  /// Pairs about which nothing is promised: features that cross or touch since the start, and
  /// those around them.
  std::size_t open_pairs() const { return open_pairs_ + tangles_.size() + heaps_; }
  /// Whether so much of a cloth crosses that it is not looked at: it passes through all cloth until
  /// its springs have spread it out, and is untangled then.
  bool is_heap(std::size_t cloth) const { return is_heap_[cloth] != 0; }
  /// Says that a tick begins, of whose work `work` shall tell.
  void begin_tick() { tangles_.begin_tick(); }
  /// Work since then on what started through each other [J].
  double work() const { return tangles_.work(); }
  /// Says that it ends: `rows` is up to date.
  void end_tick() { row_deals_.give_back(rows_, executor_); }
  /// The cloths, two by two and each two once, that started through each other or themselves and
  /// are not apart yet. Allocates.
  std::vector<std::array<Index, 2>> tangled_cloths() const;
  /// What started through each other and is not apart yet.
  const ClothTangles<Real>& tangles() const { return tangles_; }

 private:
  /// A pair whose coming step is certified by itself.
  struct Critical {
    Index pair;
    Vec3<Real> normal;
    Real gap;
    bool fixed;  ///< stopped at planes
  };

  // guard_pairs.cpp
  void collect(const ClothState<Real>& state, Real dt, Profile& profile);
  void collect_strays(Real dt, Profile& profile);
  void drop_pairs_of_strays();
  void admit_pairs(std::size_t first);
  void list_pairs(std::size_t first);
  /// Where a particle's predicted path is at a time after all pairs were collected [m].
  Quad<Real> on_path(std::size_t i, Real time) const {
    return from_[i] + velocity_[i] * (time - since_[i]);
  }
  void predict(Real past);
  /// Mean of value(i) over all particles that are awake.
  template <class Value>
  Quad<Real> mean_awake(Value&& value) const {
    Quad<Real> sum;
    for (const IndexRange& range : awake_) {
      for (Index i = range.first; i < range.end(); ++i) sum += value(static_cast<std::size_t>(i));
    }
    return sum * (Real(1) / static_cast<Real>(std::max<std::size_t>(awake_count_, 1)));
  }
  Quad<Real> path_velocity(std::size_t particle, Real dt) const;
  Quad<Real> steady(const Quad<Real>& v, std::size_t particle, Real dt) const;
  void join_pairs();
  void share_all_gaps();
  PairPoints<Real> points(const GuardedPair<Real>& pair, const QuadArray<Real>& x) const;
  template <class Visit>
  void for_pairs_of(std::size_t particle, Visit&& visit) {
    const auto end = static_cast<std::size_t>(pairs_end_[particle]);
    for (auto k = static_cast<std::size_t>(pairs_begin_[particle]); k < end; ++k) {
      GuardedPair<Real>& pair = pairs_[static_cast<std::size_t>(pairs_of_[k])];
      if (!pair.gone) visit(pair);
    }
    for (Index link = later_[particle]; link != kNone;) {
      GuardedPair<Real>& pair = pairs_[static_cast<std::size_t>(link / 4)];
      link = pair.next[static_cast<std::size_t>(link % 4)];
      if (!pair.gone) visit(pair);
    }
  }

  // guard_patches.cpp
  void test_near_patches(bool all, Profile& profile);
  void fit_near_patches();
  void search(std::size_t first, std::size_t last, bool all, PairSearch<Real>& s) const;
  void test_patches(Index p, Index q, bool all, PairSearch<Real>& s) const;
  void test_triangles(Index p, Index q, const PatchOverlaps::Bits& overlaps,
                      PairSearch<Real>& s) const;
  void test_edges(Index p, Index q, PairSearch<Real>& s) const;
  PatchMarks changed_in(Index p, bool all) const;
  void test_pair(PairKind kind, Index a, Index b, const std::array<Index, 4>& particle,
                 PairSearch<Real>& s) const;
  void keep_near(PairColumns<Real>& columns, PairSearch<Real>& s) const;
  bool is_apart(const GuardedPair<Real>& pair) const;

  // guard_tangles.cpp
  void find_tangles(const ClothState<Real>& state);
  void look_through(Index p, Index q);
  void note_crossings(Index p, Index q, std::size_t count);
  std::size_t cloth_of(Index patch) const {
    return static_cast<std::size_t>(part_of(tree_.patch(patch).particles.front()));
  }
  bool in_heap(Index patch) const { return heaps_ > 0 && is_heap(cloth_of(patch)); }
  void note_touches();

  // guard_regions.cpp
  struct Speeds {
    Real first, second;
  };
  void measure_steps();
  Speeds speeds(const GuardedPair<Real>& pair) const;
  void find_strays(const ClothState<Real>& state, Real dt);
  void find_loose();
  void anchor(const std::vector<Index>& list);
  void anchor_wave(bool first);
  void anchor_all();
  void measure(GuardedPair<Real>& pair);
  void list_claims(Index particle, AnchorPart<Real>& part);
  void measure_claimed(AnchorPart<Real>& part) const;
  Real share_claims(std::span<const AnchorClaim<Real>> claims, bool first,
                    AnchorPart<Real>& part) const;

  // guard_critical.cpp
  bool common_way_is_short() const;
  void halt(ClothState<Real>& state);
  bool stays_calm(const ClothState<Real>& state, Real dt) const;
  bool has_leeway(const ClothState<Real>& state, Real dt) const;
  void note_ends(const ClothState<Real>& state, Real dt);
  void note_paths();
  void stop_crossings();
  bool find_critical();
  bool is_critical(GuardedPair<Real>& pair);
  bool holds(const Critical& c) const;
  void fix(Critical& c);
  void truncate(ClothState<Real>& state, Real dt, bool stay);
  void count_motion();

  // guard_rows.cpp
  bool find_moved();
  void renew_rows(const ClothState<Real>& state, Profile& profile);
  bool has_moved(const std::array<Index, 4>& particles) const;
  void drop_moved_rows();
  void list_row(std::size_t r);
  void list_moved_pairs();
  void make_near_rows(const ClothState<Real>& state, RowPart<Real>& part) const;
  bool has_row(const GuardedPair<Real>& pair) const;
  void add_arrived(const ClothState<Real>& state, Profile& profile);
  bool is_beyond(const GuardedPair<Real>& pair) const;
  bool make_row(const ClothState<Real>& state, const GuardedPair<Real>& pair,
                const PairSeparation<Real>& s, GuardRow<Real>& row) const;
  void add_row(GuardRow<Real>& row);
  Real radius_of(const GuardedPair<Real>& pair, Index p, Index q) const;

  // guard_turns.cpp
  void turn_rows(const ClothState<Real>& state, Profile& profile);
  void turn_rows(const ClothState<Real>& state, std::size_t list);
  void turn(const ClothState<Real>& state, const PairSeparation<Real>& s,
            GuardRow<Real>& row) const;
  bool weigh(const ClothState<Real>& state, const PairSeparation<Real>& s,
             GuardRow<Real>& row) const;
  GuardRow<Real>* row_before(const GuardRow<Real>& row);
  void remember(GuardRow<Real>& row);

  // guard_borders.cpp
  void find_who_is_across();
  bool owns_nearest(Index triangle, const std::array<Index, 4>& particles,
                    const PairSeparation<Real>& s) const;

  // guard_solve.cpp
  void forget_rows();
  void look_at_rows(const ClothState<Real>& state, Real dt, Profile& profile);
  void load_rows(const ClothState<Real>& state);
  void store_rows(ClothState<Real>& state) const;
  void find_busy_rows(Real dt);
  bool is_busy(GuardRow<Real>& row, Real time) const;
  void warm_rows(Real dt, Real kicked);
  Real sweep_rows();
  void measure_pressures();
  Real push_rows(std::span<const RowBlock<Real>> blocks);

  Index part_of(Index particle) const;

  Executor* executor_ = nullptr;
  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  /// Of each triangle, who is across the edge opposite to a corner; none on a rim.
  std::vector<std::array<Index, 3>> across_;
  Neighbours neighbours_;
  QuadArray<Real> rest_positions_;
  std::vector<IndexRange> particles_of_;           ///< each cloth
  std::vector<Real> thickness_, friction_, cell_;  ///< of each cloth; cell: length of its edges [m]
  Real thickest_ = 0, reach_ = 0, finest_ = 0;
  PatchTree<Real> tree_;
  std::vector<char> resting_;      ///< 1 for each patch of a cloth that sleeps
  std::vector<IndexRange> awake_;  ///< particles of the cloths that do not
  std::size_t awake_count_ = 0;    ///< of them

  // Collection.
  bool collected_ = false;
  PredictedMotion<Real> motion_;  ///< less the common motion
  QuadArray<Real> from_;          ///< where each one's predicted path begins [m]
  std::vector<Real> since_;       ///< and when, after all pairs were collected [s]
  QuadArray<Real> velocity_;      ///< along the predicted paths [m/s]
  Quad<Real> off_path_;           ///< mean way off the paths after the last step [m]
  Quad<Real> off_path_now_;       ///< with which this step was looked at [m]
  Quad<Real> off_path_before_;    ///< and the step before [m]
  Quad<Real> common_velocity_;    ///< of all when pairs were collected [m/s]
  std::vector<Index> strays_;     ///< particles that leave the balls around their paths
  std::vector<char> changed_, is_active_;
  std::vector<std::uint64_t> dropped_keys_;
  Real horizon_ = 0, elapsed_ = 0;  ///< how long pairs hold, and how old they are [s]
  Real fastest_ = 0;                ///< along a path, less the common velocity [m/s]
  bool calm_ = false;               ///< there was no pair when the step began
  Vec3Array<Real> x_before_;        ///< then, where each was when it began [m]
  CalmPaths<Real> calm_paths_;      ///< if there was no pair then; bases with noted_off_path_
  Quad<Real> noted_off_path_;       ///< off_path_ when these were noted [m]
  Real smallest_gap_ = 0;           ///< that is left between features after every step [m]
  std::vector<std::pair<Index, Index>> near_patches_;  ///< whose features are to be tested
  PatchBoxes<Real> boxes_;
  std::vector<Index> to_fit_;               ///< patches among these whose boxes do not fit
  std::vector<PairSearch<Real>> searches_;  ///< of parts of these
  ColumnsByKind<Real> columns_;             ///< pairs of each kind that are looked at together
  std::vector<GuardedPair<Real>> pairs_;
  std::size_t open_pairs_ = 0;
  ClothTangles<Real> tangles_;
  std::vector<char> is_heap_;              ///< of each cloth
  std::vector<std::size_t> crossings_of_;  ///< each cloth, until it is a heap
  std::size_t heaps_ = 0;
  bool unseen_ = true;          ///< nobody has looked yet whether something crosses
  std::size_t most_pairs_ = 0;  ///< with those that are gone, until all are collected anew
  std::vector<Index> pairs_begin_, pairs_end_, pairs_of_;  ///< for each particle its pairs
  std::vector<Index> later_;   ///< for each the last that came later, as GuardedPair::next
  std::vector<Index> active_;  ///< particles in pairs

  // Regions.
  QuadArray<Real> legal_;  ///< certified positions before the drift, where rows are solved too [m]
  QuadArray<Real> step_;   ///< and the motion wanted in it [m]
  QuadArray<Real> anchor_;
  std::vector<Real> room_, moved_, fraction_;
  /// By how much everybody may still leave where he was at the end of the last step that was looked
  /// at, and when and where that was [m, s, m].
  Real leeway_ = 0, looked_ = 0;
  Vec3Array<Real> ends_;
  std::vector<std::uint32_t> wave_of_;
  std::vector<std::uint64_t> anchored_at_;  ///< step in which each was anchored last
  std::uint32_t wave_ = 0;
  std::uint64_t substep_ = 0;
  std::uint64_t measured_steps_ = 0;            ///< step in which step_length_ was measured last
  std::vector<Real> step_length_;               ///< of step_ [m]
  std::vector<AnchorPart<Real>> anchor_parts_;  ///< of the particles of a wave
  std::vector<Index> loose_, next_, wave_list_, anchored_, dirty_, tight_;
  double lost_ = 0;     ///< motion truncated in this step [m]
  double allowed_ = 0;  ///< and what is left of it, in the last one that was looked at [m]
  std::uint32_t listing_ = 0;
  std::vector<Critical> critical_;
  std::vector<char> is_tight_;

  // Rows.
  bool rows_built_ = false, rows_lack_ = false;  ///< rows_lack_: some of their radius
  QuadArray<Real> x_rows_;                       ///< when the rows of each particle were made [m]
  Real rows_time_ = 0;                           ///< since all were looked at more closely [s]
  int rows_steps_ = 0;
  Real kicked_ = 0;       ///< time of the forces that the rows' impulses stand against [s]
  bool upwards_ = false;  ///< which way the last sweep went
  bool closed_ = true;    ///< the last tick has been settled, and nothing solved since
  std::vector<GuardRow<Real>> rows_, old_rows_;
  std::vector<std::pair<std::uint64_t, Index>> old_keys_;
  std::vector<GuardedPair<Real>> arrived_;  ///< pairs that came since rows were built
  std::vector<char> in_rows_;
  std::vector<Index> first_row_;  ///< for each particle the last row whose first one it is
  std::vector<Index> next_row_;   ///< and for each row the one before
  std::vector<Index> moved_particles_;
  std::vector<Index> looked_at_;  ///< pairs of these
  std::vector<RowPart<Real>> row_parts_;
  std::vector<Index> passed_;  ///< over the border of a triangle that carries them
  std::vector<char> is_moved_;
  QuadArray<Real> quad_v_;                  ///< their velocities while rows are solved [m/s]
  QuadArray<Real> extra_;                   ///< velocity of the push [m/s]
  RowSlabs<Real> row_slabs_;                ///< those that push or soon may are busy
  bool rows_listed_ = false;                ///< there, all of them
  RowDeals<Real> row_deals_;                ///< the busy ones between two looks
  std::vector<TurnPart<Real>> turn_parts_;  ///< of each of their lists
  std::vector<Real> inverse_area_;          ///< of fabric that belongs to each particle [1/m^2]
  std::vector<Real> pressure_;              ///< about particles in rows, at the last look [Pa]
  Real most_pressure_ = 0;                  ///< of these [Pa]
  std::vector<Index> pushed_;
  std::vector<char> is_pushed_;
  Vec3Array<Real> pushed_v_;  ///< their velocities with it

  GuardCounts counts_;
};

extern template class ClothGuard<float>;
extern template class ClothGuard<double>;

}  // namespace weft
