#pragma once

#include <array>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/types.h"

namespace weft {

/// What a row-wise kernel reads and writes. Component arrays have `stride` numbers a row,
/// kGridMargin of them before column 0, and two rows of zeros above and below; pointers are at (row
/// 0, column 0).
template <class Real>
struct GridView {
  int rows = 0, columns = 0;
  std::ptrdiff_t stride = 0;
  const Real* x[3] = {};              ///< positions [m]
  const Real* v[3] = {};              ///< velocities [m/s]
  const Real* wind[3] = {};           ///< velocity of the air [m/s]
  const Real* cell = nullptr;         ///< by column: 1 where a cell begins, 0 elsewhere
  const Real* border_half = nullptr;  ///< by column: 1/2 on the border lines, 1 between, 0 outside
  const Real* inner = nullptr;        ///< by column: 1 strictly between the border lines, else 0
  const Real* odd = nullptr;          ///< by column: 1 for odd columns, else 0
  GridSprings<Real> springs;
  QuadraticBending<Real> bending;
  Real* scratch = nullptr;  ///< kGridScratchRows rows of `stride` numbers, at column 0
};

inline constexpr int kGridMargin = 16;  ///< at least the widest vector, in numbers
inline constexpr int kGridScratchRows = 48;

/// The forces of one part of the model, a grid, row by row: every spring, bending stencil and
/// triangle once, as vector code chosen for the processor when the program runs. The results do not
/// depend on that choice: only + - * / and square roots, in a fixed order, without fused
/// multiply-adds.
template <class Real>
class GridPass {
 public:
  /// Sizes the arrays. A part that is no grid or has hinges, skip springs or direct springs does
  /// not fit and stays with the element-wise form.
  void prepare(const ClothPart<Real>& part);

  bool fits() const { return view_.rows > 0; }

  /// Takes positions and velocities of the whole model for the calls below.
  void load(const Vec3Array<Real>& x, const Vec3Array<Real>& v);
  void load_wind(const Vec3Array<Real>& wind);

  /// Forces of springs, dashpots and bending on each particle of the part [N]; overwrites its
  /// stretch of `force`, which is the whole model's.
  void compute_internal_forces(Vec3Array<Real>& force);

  /// Force of the air on each particle [N]; overwrites as above. Formula in air.h.
  void compute_air_forces(double density, Vec3Array<Real>& force);

 private:
  using Components = std::array<std::vector<Real>, 3>;
  void scatter(const Vec3Array<Real>& values, Components& components) const;
  const Real* at_origin(const std::vector<Real>& array) const;

  GridView<Real> view_;
  std::size_t first_ = 0;  ///< particle of the model that is particle 0 of the grid
  Real air_normal_ = 0, air_tangential_ = 0;
  Components x_, v_, wind_;
  std::vector<Real> cell_, border_half_, inner_, odd_, scratch_;
};

/// Name of the instruction set that the kernels use on this processor, e.g. "AVX2".
const char* simd_level();

}  // namespace weft
