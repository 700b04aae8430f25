#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/guard/guard_row.h"
#include "core/contact/guard/guarded_cloths.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/contact/guard/pair_separation.h"
#include "core/contact/guard/row_set.h"
#include "core/contact/guard/stopped_particles.h"
#include "core/executor.h"
#include "core/profile.h"
#include "core/types.h"

// Makes the rows of near pairs, anew for particles that have moved, and turns those that push.

namespace weft {

/// What rows are made from.
template <class Real>
struct RowSource {
  const GuardedCloths<Real>& cloths;
  const ClothState<Real>& state;          ///< its velocities and inverse masses
  const QuadArray<Real>& x;               ///< positions [m]
  Real smallest_gap;                      ///< that certificates leave [m]
  const std::vector<JammedPair>& jammed;  ///< see RowMaking
};

/// What one part of making or turning rows needs, and the rows that it made of each kind.
template <class Real>
struct RowPart {
  ColumnsByKind<Real> columns;
  std::array<std::vector<GuardRow<Real>>, 2> rows;
  std::vector<Index> passed;  ///< particles over the border of the triangle that carries them
};

/// When and where rows were made, and what was dropped in exchange.
template <class Real>
struct RowMaking {
  bool made = false;               ///< rows exist for all near pairs
  Real time = 0;                   ///< since all were examined more closely [s]
  int steps = 0;                   ///< since all were made
  QuadArray<Real> x;               ///< when the rows of each particle were made [m]
  std::vector<Index> moved;        ///< particles whose rows have to be made anew
  std::vector<char> is_moved;      ///< of each particle
  std::vector<Index> passed;       ///< particles over the border of a triangle that carries them
  std::vector<JammedPair> jammed;  ///< pairs that may have rows as they are jammed, by their keys
  std::vector<Real> off_anchor;    ///< distance of each particle from its anchor [m]
  std::vector<Index> candidates;   ///< pairs of the particles that have moved
  std::vector<RowPart<Real>> parts;
  std::vector<GuardRow<Real>> old_rows;                   ///< dropped; impulses are taken over
  std::vector<std::pair<std::uint64_t, Index>> old_keys;  ///< theirs, ascending
};

/// @param particles  number of all
template <class Real>
RowMaking<Real> row_making(std::size_t particles);

/// Forgets all that was made; keeps the memory.
template <class Real>
void forget_made(RowMaking<Real>& making);

/// Whether it is time to choose the busy rows and turn those that push.
template <class Real>
bool is_time_to_look(const RowMaking<Real>& making) {
  return making.steps % kStepsBetweenLooks == 0;
}

/// Notes where the particles of pairs are that had none: they have no rows yet.
/// @param first  number of the first new pair, which is not listed yet
template <class Real>
void place_new_particles(const GuardedPairs<Real>& pairs, std::size_t first,
                         const QuadArray<Real>& x, RowMaking<Real>& making);

/// Notes pairs that are jammed, whose rows then are made anew.
/// @param found  in the last step
template <class Real>
void note_jammed(const std::vector<JammedPair>& found, RowMaking<Real>& making);

/// Lists the particles whose rows have to be made anew.
/// @return whether there are any
template <class Real>
bool find_moved(const std::vector<Index>& active, const QuadArray<Real>& x, Real thickest,
                RowMaking<Real>& making);

/// Makes the rows anew of the particles that have moved.
/// @param anchor  of all particles [m]; the bounds of pairs hold there
template <class Real>
void renew_rows(const RowSource<Real>& source, const QuadArray<Real>& anchor,
                GuardedPairs<Real>& pairs, RowMaking<Real>& making, RowSet<Real>& rows,
                Executor* executor, Profile& profile);

/// Makes the rows of pairs that arrived since rows were made.
template <class Real>
void add_arrived(const RowSource<Real>& source, GuardedPairs<Real>& pairs, RowMaking<Real>& making,
                 RowSet<Real>& rows, Profile& profile);

/// Turns the busy rows that push with their features. Frozen until they are made anew, they would
/// jump then, and what rests on them would never come to rest.
template <class Real>
void turn_rows(const RowSource<Real>& source, RowMaking<Real>& making, RowSet<Real>& rows,
               Executor* executor, Profile& profile);

}  // namespace weft
