#pragma once

#include <cassert>
#include <span>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/executor.h"
#include "core/forces/force_pass.h"
#include "core/forces/grid_view.h"
#include "core/geometry/aabb.h"
#include "core/math/aligned_vector.h"
#include "core/types.h"

// Row-wise forces and steps of grids in vector code.

namespace weft {

/// Forces of one grid part, whole or cut, row by row: each spring, bending stencil and triangle
/// once per pass, in vector code selected for the processor at run time. The results do not depend
/// on that selection: only + - * / fma and square roots, in a fixed order.
///
/// It advances its own copies of positions and velocities, split into components; they are loaded
/// from and stored into the arrays of the whole model.
template <class Real>
class GridPass {
 public:
  /// Sizes the arrays that are always needed. A part that is not a grid, or has hinges, threads
  /// that lock, skip springs or direct springs, does not fit and keeps the element-wise form.
  void prepare(const ClothPart<Real>& part);

  /// Sizes the arrays of external forces, and of the wind if there is air. Must precede every call
  /// that uses them.
  void allocate_external(bool air);

  /// Sizes the arrays that `load_paths` and `keep` fill. Must precede both.
  void allocate_paths();

  /// Sizes the arrays for `advance` on several threads. Without them it runs on one.
  void allocate_bands();

  bool fits() const { return view_.rows > 0; }

  /// Loads positions and velocities of the whole model for the calls below, and chooses the origin
  /// from which they are seen from now on.
  /// @param executor  runs bands of rows on its threads; may be null, here and below
  void load(const Vec3Array<Real>& x, const Vec3Array<Real>& v, Executor* executor = nullptr);
  /// Loads velocities, and positions that are no longer those that were stored.
  void take_over(const Vec3Array<Real>& x, const Vec3Array<Real>& v, Executor* executor = nullptr);
  void load_velocities(const Vec3Array<Real>& v, Executor* executor = nullptr);
  /// Forgets what drifts lost of a particle's position to rounding.
  /// @param particle  in the arrays of the whole model
  void forget_remainder(Index particle, const Vec3<Real>& x);
  void load_positions(const Vec3Array<Real>& x);
  void load_inverse_mass(const std::vector<Real>& inverse_mass);
  void load_wind(const Vec3Array<Real>& wind);
  void load_external(const Vec3Array<Real>& force);

  /// Loads straight paths of the whole model's particles.
  /// @param base      positions at time 0 [m]
  /// @param velocity  along the paths [m/s]
  void load_paths(const Vec3Array<Real>& base, const Vec3Array<Real>& velocity);

  /// Bounding box of all particles' displacements from their paths [m].
  /// @param time  of the present positions [s]
  Aabb<Real> box_off_paths(Real time) const;

  /// Saves positions and velocities for `take_back`.
  void keep() {
    assert(kept_.size() == motion_.size() && "allocate_paths comes first");
    kept_ = motion_;
  }
  void take_back() {
    assert(kept_.size() == motion_.size());
    motion_ = kept_;
  }

  void store(Vec3Array<Real>& x, Vec3Array<Real>& v, Executor* executor = nullptr);
  void store_velocities(Vec3Array<Real>& v, Executor* executor = nullptr);
  void store_external(Vec3Array<Real>& force) const;
  /// Positions and velocities of some particles alone.
  /// @param particles  of this grid, in the arrays of the whole model, ascending
  void store(std::span<const Index> particles, Vec3Array<Real>& x, Vec3Array<Real>& v) const;

  /// One substep with the forces of springs, dashpots, bending and, if the step says so, the
  /// external ones.
  /// @returns power of the external forces at the new velocities [W]
  double advance(const GridStep<Real>& step, Executor* executor = nullptr);

  /// Takes over the model's motion, and moves its positions by dt.
  /// @returns power of the external forces [W]; 0 without them
  double drift(Real dt, bool has_external, const Vec3Array<Real>& v, Vec3Array<Real>& x,
               Executor* executor = nullptr);

  /// Forces of springs, dashpots and bending on each particle of the part [N]. Overwrites its range
  /// of `force`, which is the whole model's, and the external forces, whose arrays it sizes.
  void compute_internal_forces(Vec3Array<Real>& force);

  /// Stores the air's force on each particle as the external force [N]. Formula in air_force.h.
  void compute_air_forces(double density);

  /// Energies of springs and bending, and the largest strain, at the grid's positions. Sums are per
  /// column in Real, then in double.
  ElasticEnergy elastic_energy() const;

  /// Size of the arrays [B].
  std::size_t bytes() const;

 private:
  /// Private data of a band of rows that is advanced in parallel with others: scratch, and its last
  /// two rows with copies of the next two in their old state.
  struct Band {
    AlignedVector<Real> scratch, tail;
    double power = 0;  ///< of the external forces [W]
  };

  int band_count() const;
  std::ptrdiff_t first_row(int band) const;
  GridView<Real> view_of(Band& band) const;
  GridView<Real> rows_of(int band);
  template <class Work>
  void for_bands(Executor* executor, Work&& work);
  void begin_band(int number);
  void advance_band(int number, const GridStep<Real>& step);
  Real* allocate(AlignedVector<Real>& array, std::ptrdiff_t lines) const;
  void lay_out(const ClothPart<Real>& part);
  void lay_out_coefficients(const ClothPart<Real>& part);

  GridView<Real> view_;
  IndexRange particles_;
  Real air_normal_ = 0, air_tangential_ = 0;
  std::vector<GridRow<Real>> rows_;
  std::vector<Band> bands_;
  AlignedVector<Real> motion_, external_, wind_, coefficients_, odd_, scratch_;
  AlignedVector<Real> paths_, kept_;
};

/// Name of the instruction set that the kernels use on this processor, e.g. "AVX2".
const char* simd_level();

}  // namespace weft
