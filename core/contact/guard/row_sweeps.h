#pragma once

#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/guard/row_set.h"
#include "core/executor.h"
#include "core/math/quad.h"
#include "core/types.h"

// The contact solver of cloths: projected Gauss-Seidel on the velocities of rows.

namespace weft {

/// What sweeps carry from one to the next.
template <class Real>
struct RowSweeps {
  QuadArray<Real> v;     ///< velocities of particles in rows, while these respond [m/s]
  Real kicked = 0;       ///< time of the forces that the rows' impulses stand against [s]
  bool upwards = false;  ///< direction of the last sweep
  bool lack = false;     ///< some rows lack so much of their radius that they are pushed apart
};

/// Copies positions or velocities of all particles.
template <class Real>
void copy_in(const Vec3Array<Real>& from, QuadArray<Real>& to, Executor* executor);

/// Copies the velocities of the particles that rows have, or of all if that costs less.
template <class Real>
void load_velocities(const Vec3Array<Real>& from, const RowSlabs<Real>& slabs, QuadArray<Real>& to,
                     Executor* executor);
/// Copies them back.
template <class Real>
void store_velocities(const QuadArray<Real>& from, const RowSlabs<Real>& slabs, Vec3Array<Real>& to,
                      Executor* executor);

/// Lists the rows that push or may have to before the next look, of a step of `dt` [s].
/// @param x  positions [m]
template <class Real>
void find_busy_rows(const QuadArray<Real>& x, const QuadArray<Real>& v, Real dt, RowSet<Real>& rows,
                    Executor* executor);

/// Measures the pressure about each particle of a row, summed over all rows at it, because how a
/// load divides among single rows is arbitrary. Layers are pressed from both sides.
/// @param inverse_area  of the fabric that belongs to each particle [1/m^2]
/// @param kicked        time of the forces that the impulses stand against [s]
template <class Real>
void measure_pressures(const std::vector<Real>& inverse_area, Real kicked, RowSet<Real>& rows,
                       Executor* executor);

/// Starts from the impulses of the last step.
/// @param kicked  time of the forces since then that they have to stand against [s]
template <class Real>
void warm_start(const QuadArray<Real>& x, Real dt, Real kicked, RowSet<Real>& rows,
                RowSweeps<Real>& sweeps, Executor* executor);

/// Sweeps once over the busy rows, from either end in turn.
/// @return largest change of a normal velocity [m/s]
template <class Real>
Real sweep_once(const QuadArray<Real>& x, RowSet<Real>& rows, RowSweeps<Real>& sweeps,
                Executor* executor);

}  // namespace weft
