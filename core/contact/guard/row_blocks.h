#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/contact/guard/guard_row.h"

// The guard's response in vector code: eight rows without a common particle at a time.

namespace weft {

/// Rows that push nothing forget what they slipped where their gap exceeds the radius by more than
/// this fraction of it [1].
inline constexpr double kBusyRoom = 0.02;

/// Time in which a contact that sticks goes back to its anchor [s], but no faster than this, which
/// is too slow to see [m/s]; and how far that may be, as a part of the radius: what slides drags
/// its anchor along, and what did so for a moment, as the load went over to other rows, goes back.
inline constexpr double kStickTime = 0.02, kFastestReturn = 1e-3, kMostSlip = 0.008;

/// A lack of this part of the radius is let be: what cannot part, in tight folds, would be pushed
/// for ever, and the push drives the springs that bring it back.
inline constexpr double kPushSlack = 0.1;

/// Layers lose thickness in proportion to pressure. All of it would go at kFlattening, the pressure
/// at which the KES test measures a loss of a third to a half [Pa]; but no more than the part
/// kMostFlattening goes [1]. The lost thickness is not pushed back: the push would stretch the
/// layers and lift what presses them, with energy from nowhere.
inline constexpr double kFlattening = 5e3, kMostFlattening = 0.75;

/// Harder pressed than this, as only between objects, layers let go of so much of what they press
/// each other with in a step, at twice the pressure [Pa].
inline constexpr double kCrushing = 2e4, kLeak = 0.1;

/// Rows without a common particle, padded with kNone.
inline constexpr std::size_t kBatchRows = 8;
using RowBatch = std::array<Index, kBatchRows>;

/// Such rows number by number, so that all respond at once.
template <class Real>
struct RowBlock {
  using Numbers = std::array<Real, kBatchRows>;

  RowBatch row;  ///< which they are
  /// Where the numbers of each particle begin in an array of quads.
  std::array<std::array<std::uint32_t, kBatchRows>, 4> place;
  std::array<Numbers, 4> weight, share;
  std::array<Numbers, 3> normal, drag, slip, apart;
  Numbers inertia, radius, friction, room, least_speed, push;
  Numbers lack;         ///< of the radius, less what pressure takes, of those that are pushed [m]
  std::uint32_t lacks;  ///< bit k: the k-th row is to be pushed apart
  std::size_t count;    ///< of rows; what is behind responds to nothing

  RowBlock() = default;
  /// Takes over the rows of a batch.
  RowBlock(const RowBatch& batch, std::span<const GuardRow<Real>> rows);
  /// Gives back what responses changed.
  void give_back(std::span<GuardRow<Real>> rows) const;
  /// A vector of the k-th row.
  static Quad<Real> quad(const std::array<Numbers, 3>& of, std::size_t k) {
    return to_quad<Real>({of[0][k], of[1][k], of[2][k]});
  }
  std::size_t particle(std::size_t n, std::size_t k) const { return place[n][k] / 4; }
  /// sum w of what the particles of the k-th row have.
  Quad<Real> weighted(std::size_t k, const Quad<Real>* values) const {
    Quad<Real> sum = values[particle(0, k)] * weight[0][k];
    for (std::size_t n = 1; n < 4; ++n) sum += values[particle(n, k)] * weight[n][k];
    return sum;
  }
  /// Gives an impulse [N s] to the particles of the k-th row.
  void share_out(std::size_t k, const Quad<Real>& impulse, Quad<Real>* velocities) const {
    for (std::size_t n = 0; n < 4; ++n) velocities[particle(n, k)] += impulse * share[n][k];
  }
};

/// What is behind the rows of a block: it has the particles of the first one, and no weight.
template <class Real>
GuardRow<Real> idle_row(const GuardRow<Real>& first) {
  GuardRow<Real> row;
  row.particle = first.particle;
  row.inertia = 1;
  return row;
}

/// What blocks respond to in a step.
template <class Real>
struct RowPass {
  const Quad<Real>* x = nullptr;   ///< of all particles [m]
  Quad<Real>* v = nullptr;         ///< [m/s]
  const Real* pressure = nullptr;  ///< about them [Pa]
  Real most_pressure = 0;          ///< of these [Pa]
  Real dt = 0;                     ///< of the step [s]
  Real warm = 0;                   ///< part of the last step's impulses to start from
};

// All of these have the bits of one row after the other, for any instruction set.

/// Takes over the rows of batches. @param blocks  as many
void take_rows(std::span<const RowBatch> batches, std::span<const GuardRow<float>> rows,
               std::span<RowBlock<float>> blocks);
void take_rows(std::span<const RowBatch> batches, std::span<const GuardRow<double>> rows,
               std::span<RowBlock<double>> blocks);

/// Sets the normal velocity that each row must reach, no nearer than its radius within the step,
/// and starts from its impulses of the last step. Adds to the slip how far it really went. A
/// row that bounces a little, as those of a resting cloth do, keeps its anchor: it would creep down
/// every slope.
///
/// What is pressed very hard keeps less of its impulse. Between objects that do not give way,
/// layers can press each other and the objects with any force whatever: it is in balance and none
/// of it is seen in a velocity. Each error adds to it and nothing takes from it, until its own
/// errors drive the cloth. So it leaks away; what is needed comes back in the sweeps.
/// @return whether any row lacks more of its radius than is let be, and is to be pushed apart
template <class Real>
bool warm_rows(std::span<RowBlock<Real>> blocks, const RowPass<Real>& pass);

/// Projected Gauss-Seidel. Friction brings what sticks back to its anchor, and lets it slide where
/// that takes more than Coulomb's bound.
/// @param upwards  from the first block to the last, or the other way
/// @return largest change of a normal velocity [m/s], and 0
template <class Real>
Real sweep_rows(std::span<RowBlock<Real>> blocks, bool upwards, const RowPass<Real>& pass);

extern template struct RowBlock<float>;
extern template struct RowBlock<double>;

}  // namespace weft
