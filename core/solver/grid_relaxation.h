#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/cloth/bending_stencil.h"
#include "core/cloth/cloth_model.h"
#include "core/math/aligned_vector.h"
#include "core/types.h"

// Compliant relaxation of grids in vector code.

namespace weft {

/// The data of the kernels of the compliant sweeps. Particles of a row with even and odd columns
/// are separated, so that the springs of one colour are adjacent in memory: particle (r, c) is at r
/// * stride + (c % 2) * half + c / 2. Each half row is surrounded by at least kSweepMargin zeros,
/// and the grid by two rows of zeros above and below.
template <class Real>
struct SweepView {
  int rows = 0, columns = 0;
  std::ptrdiff_t half = 0, stride = 0;
  Real origin[3] = {};           ///< near the places when they were loaded [m]
  Real* x[3] = {};               ///< positions at the start of the substep, from the origin [m]
  Real* displacement[3] = {};    ///< x' - x, displacement of the substep [m]
  const Real* force[3] = {};     ///< of hands, slings and air [N]; read on request
  const Real* w = nullptr;       ///< inverse masses [1/kg], 0 if pinned
  const Real* free = nullptr;    ///< 1, or 0 if pinned
  const Real* share[4] = {};     ///< 1/(w_i + w_j + alpha~) [kg] of each spring by its first cell:
                                 ///< along, down, falling, rising
  Real* multiplier[4] = {};      ///< lambda [m kg]; used with more than one sweep
  const Real* border = nullptr;  ///< by column: 1/2 on border lines, else 1
  const Real* softer = nullptr;  ///< by column: 2 on border lines, else 1
  /// Bending along the rows, by column; see BendingRow.
  const Real *bend_left = nullptr, *bend = nullptr, *bend_right = nullptr;
  const Real *cell_left = nullptr, *cell_right = nullptr;
  std::vector<BendingRow<Real>> row_bend;  ///< bending across the rows, by row
  Real length[3] = {};                     ///< rest lengths: along, down, diagonal [m]
  Real alpha[3] = {};  ///< alpha~ inside the grid [1/kg]; 0 without such springs
  QuadraticBending<Real> bending;
};

inline constexpr int kSweepMargin = 16;  ///< not less than the widest vector, in numbers

/// Constants of a prediction: displacement <- keep displacement + dt2 (f w + g).
template <class Real>
struct Prediction {
  Real keep = 1, dt2 = 0;
  Vec3<Real> gravity = Vec3<Real>::Zero();
  bool forced = false;  ///< add `force`
};

template <class Real>
void predict_grid(const SweepView<Real>& grid, const Prediction<Real>& step);

/// One sweep over all springs, row by row, either down or up.
/// @param first  all multipliers are 0 before it
/// @param last   the multipliers are not read after it
template <class Real>
void sweep_grid(const SweepView<Real>& grid, bool down, bool first, bool last);

/// x <- x + displacement.
template <class Real>
void move_grid(const SweepView<Real>& grid);

/// Compliant relaxation (XPBD) of one grid part with regular springs: the sweeps of relaxation.h,
/// coloured within each row, in vector code selected for the processor at run time. Only + - * /
/// and square roots in a fixed order, so the selection does not change a bit. The variable is the
/// displacement x' - x: positions of two steps agree in all but their last bits, and their
/// difference would lose float precision at small substeps.
template <class Real>
class GridRelaxation {
 public:
  /// Sizes the arrays. A part that is not a grid, or has hinges, skip springs or direct springs,
  /// does not fit and is swept spring by spring.
  void prepare(const ClothPart<Real>& part);

  bool fits() const { return view_.rows > 0; }
  const SweepView<Real>& view() const { return view_; }

  /// Sets the inverse masses and tabulates the compliance of each spring.
  /// @param softness  compliance / dt^2 [1/s^2]
  void set_masses(const std::vector<Real>& inverse_mass, Real softness);

  /// Loads positions and displacements v dt of the whole model, and chooses the origin: seen from
  /// near, places change in finer steps than the model's floats.
  void load(const Vec3Array<Real>& x, const Vec3Array<Real>& v, Real dt);
  void load_force(const Vec3Array<Real>& force);

  /// Stores positions and velocities displacement / dt.
  void store(Vec3Array<Real>& x, Vec3Array<Real>& v, Real dt) const;
  void store_displacements(Vec3Array<Real>& displacement) const;

 private:
  using Array = AlignedVector<Real>;
  Real* at_origin(Array& array) const;
  std::ptrdiff_t place(int row, int column) const {
    return row * view_.stride + (column % 2) * view_.half + column / 2;
  }
  /// Calls visit(i, place, k) for each number k of each particle; i is its number in the model.
  template <class Visit>
  void for_each_number(Visit&& visit) const;

  SweepView<Real> view_;
  GridSprings<Real> springs_;
  std::size_t first_ = 0;  ///< index in the model of the grid's particle 0
  std::array<Array, 3> x_, displacement_, force_;
  std::array<Array, 4> share_, multiplier_;
  Array w_, free_, border_, softer_, bend_left_, bend_, bend_right_, cell_left_, cell_right_;
};

}  // namespace weft
