#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/guard/awake_particles.h"
#include "core/contact/guard/calm_steps.h"
#include "core/contact/guard/critical_steps.h"
#include "core/contact/guard/guard_log.h"
#include "core/contact/guard/guarded_cloths.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/guarded_step.h"
#include "core/contact/guard/guarded_tangles.h"
#include "core/contact/guard/patch_search.h"
#include "core/contact/guard/predicted_paths.h"
#include "core/contact/guard/push_out.h"
#include "core/contact/guard/regions.h"
#include "core/contact/guard/row_making.h"
#include "core/contact/guard/row_set.h"
#include "core/contact/guard/row_sweeps.h"
#include "core/contact/guard/stopped_particles.h"
#include "core/executor.h"
#include "core/profile.h"

// Contact of cloths with themselves and each other; section 4 of core/README.md is an overview.

namespace weft {

/// The calls of a step that have been made, in their order.
enum class GuardPhase : std::uint8_t { between_steps, solved, certified };

/// Keeps particles from passing triangles, and edges from passing edges.
///
/// Detection: all particles stay in balls of `reach` around predicted straight paths, and pairs of
/// features whose balls never meet are not examined (patch_search.h). Certificates: each other pair
/// has a gap between the places where its particles were anchored, which both sides share out as
/// the radii of regions around these anchors (regions.h). While all particles stay inside theirs,
/// wherever there, nothing has crossed; one that is about to leave is anchored anew. Where no room
/// is left, the coming step itself is certified: a pair is apart throughout a step on straight
/// lines if one plane separates its sides at both ends of it. Only a pair for which that fails gets
/// two planes in its gap, at which its particles stop (critical_steps.h). A particle that does not
/// move is always allowed.
///
/// A contact solver keeps gaps open, so that the regions seldom have to: rows of near pairs, frozen
/// for some substeps (row_making.h), projected Gauss-Seidel on velocities with Coulomb friction
/// that sticks to anchors (row_sweeps.h).
///
/// This class owns the state of all these, and calls them in their order.
template <class Real>
class ClothGuard {
 public:
  ClothGuard() = default;
  /// @param executor  works through the search for pairs in chunks; may be null
  explicit ClothGuard(const ClothModel<Real>& model, Executor* executor = nullptr);

  /// Forgets everything about where the cloths are. May be called at any time.
  void reset();

  /// Says that masses changed (a pin).
  void invalidate_rows() { making_.made = false; }

  /// Says that which cloths sleep has changed: these are not examined between each other.
  /// @param asleep  of each cloth 1 if it sleeps; empty if none does
  void let_rest(const std::vector<char>& asleep);

  /// Before all other contact: the contact impulses of the last step again. `sweep` mends them.
  /// @param force_ratio  see Collision::before_drift
  void solve(ClothState<Real>& state, Real dt, Profile& profile, Real force_ratio = 1);

  /// A sweep over the rows, to be called in turn with those of other contact: what rests in layers
  /// on an object is held by both.
  /// @return largest change of a normal velocity [m/s]
  Real sweep(ClothState<Real>& state);

  /// Largest change of a normal velocity in a sweep that need not be followed by another one [m/s].
  Real residual(Real dt) const;

  /// After all sweeps: a push for features that are too near, which moves them in the coming drift
  /// without giving them velocity. No sweep may see it: what holds against the push would become
  /// impulses, and what is squeezed between objects would be pressed harder each step.
  void push_apart(ClothState<Real>& state);

  /// Sweeps and push where the cloths meet nothing else in the coming drift of `dt` [s].
  void respond_alone(ClothState<Real>& state, Real dt);

  /// After all other contact and right before the drift of `dt` [s]: lets no particle leave its
  /// region. One that has to stop earlier does so on the straight line of its motion since `solve`,
  /// as seen from what all have in common, if they have room for that.
  /// @param room  says how far any particle may go, whichever way, before it meets anything but
  ///              cloth [m]; asked where something is stopped
  void certify(ClothState<Real>& state, Real dt, const std::function<Real()>& room,
               Profile& profile);

  /// After `certify`: says that all particles stay where they were instead, off the paths that were
  /// expected. All that they wanted in this step is lost.
  void stand_still();

  /// After the drift: gives what was stopped its velocity back, and takes the push out again.
  /// @param keeps_velocity  false: velocities are displacements, and what was stopped loses them
  /// @return whether that may have changed a velocity
  bool finish(ClothState<Real>& state, bool keeps_velocity = true);

  /// Paths along which nothing can meet, for steps without the calls above; null if there are none.
  const CalmPaths<Real>* calm_paths() const {
    const bool calm = paths_.collected && pairs_.active.empty() && open_pairs() == 0;
    return calm && push_.particles.empty() ? &calm_.paths : nullptr;
  }

  /// Says that steps went by without the calls above.
  /// @param steps   how many
  /// @param time    at their end, as in the calm paths [s]
  /// @param common  mean displacement of all from their paths then [m]
  /// @param renew   look for other paths in the coming step
  void leave_calm_paths(int steps, Real time, const Vec3<Real>& common, bool renew);

  /// At the end of a tick, whose last kick is half of one: stands against that with half the
  /// impulses. `sweep` makes the velocities admissible.
  void settle(ClothState<Real>& state, Real dt, Profile& profile);

  /// Switches logging what rows push; changes no result.
  void log_forces(bool wanted) {
    clear_log(log_);
    log_.wanted = wanted;
  }
  /// Says that a tick begins, of whose work and forces `work` and `log` shall tell.
  void begin_tick() {
    tangled_.tangles.begin_tick();
    rows_.deals.forget_pushes();
    clear_log(log_);
  }
  /// Says that it ends: `rows` and `log` are up to date.
  void end_tick() {
    note_settled();
    if (log_.wanted) rows_.deals.log_pushes(rows_.all, log_);
    rows_.deals.give_back(rows_.all, executor_);
  }

  const GuardCounts& counts() const { return counts_; }
  const GuardLog& log() const { return log_; }
  /// Those that are not `gone`: all whose features come nearer than twice the reach while all
  /// particles go along their predicted paths.
  const std::vector<GuardedPair<Real>>& pairs() const { return pairs_.all; }
  /// Where a particle's predicted path is after the last step [m].
  Vec3<Real> predicted(std::size_t particle) const {
    return to_vector(paths_.at(particle, paths_.elapsed));
  }
  Real reach() const { return cloths_.reach; }
  /// At the end of a tick.
  const std::vector<GuardRow<Real>>& rows() const { return rows_.all; }
  /// Whether any cloth pressed against itself or another in the last step.
  bool presses() const { return rows_.deals.pushes(); }
  /// Whether its certificate stopped any particle in the last step.
  bool stops() const { return stopped_.any; }
  /// Pairs about which nothing is promised: features that cross or touch since the start, and
  /// those around them.
  std::size_t open_pairs() const { return pairs_.open + tangled_.open(); }
  /// Whether so much of a cloth crosses that it is not examined; see GuardedTangles.
  bool is_heap(std::size_t cloth) const { return tangled_.is_heap[cloth] != 0; }
  /// Work since the start of the tick on what started through each other [J].
  double work() const { return tangled_.tangles.work(); }
  /// The cloths, two by two and each two once, that started through each other or themselves and
  /// are not apart yet. Allocates.
  std::vector<std::array<Index, 2>> tangled_cloths() const {
    return weft::tangled_cloths(tangled_, pairs_, cloths_);
  }
  /// What started through each other and is not apart yet.
  const ClothTangles<Real>& tangles() const { return tangled_.tangles; }

 private:
  void collect(const ClothState<Real>& state, Real dt, Profile& profile);
  void collect_strays(Real dt, Profile& profile);
  void keep_in_regions(ClothState<Real>& state, Real dt, const std::function<Real()>& room,
                       Profile& profile);
  RowSource<Real> row_source(const ClothState<Real>& state) const {
    return {cloths_, state, step_.from, regions_.smallest_gap, making_.jammed};
  }
  /// Notes what was pushed when the last steps were settled, whose sweeps are over.
  void note_settled() {
    if (log_.wanted && log_.begun && settled_) rows_.deals.note_pushes(1);
  }
  void examine_rows(const ClothState<Real>& state, Real dt, Profile& profile);
  void start_rows(ClothState<Real>& state, Real dt, Real kicked, Profile& profile);

  Executor* executor_ = nullptr;
  GuardPhase phase_ = GuardPhase::between_steps;
  GuardedCloths<Real> cloths_;
  AwakeParticles awake_;
  GuardedStep<Real> step_;
  // Detect.
  PredictedPaths<Real> paths_;
  PatchSearch<Real> search_;
  GuardedPairs<Real> pairs_;
  GuardedTangles<Real> tangled_;
  // Certify.
  Regions<Real> regions_;
  CriticalSteps<Real> critical_;
  StoppedParticles<Real> stopped_;
  Slack<Real> slack_;
  CalmSteps<Real> calm_;
  // Solve.
  RowMaking<Real> making_;
  RowSet<Real> rows_;
  RowSweeps<Real> sweeps_;
  PushOut<Real> push_;
  bool settled_ = true;  ///< the last tick has been settled, and nothing solved since

  GuardCounts counts_;
  GuardLog log_;
};

extern template class ClothGuard<float>;
extern template class ClothGuard<double>;

}  // namespace weft
