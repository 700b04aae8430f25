#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/solver/implicit/conjugate_gradients.h"
#include "core/solver/implicit/linear_terms.h"
#include "core/solver/implicit/multigrid.h"
#include "core/solver/implicit/spring_planes.h"
#include "core/types.h"

// Linear systems of regular grids.

namespace weft {

/// Linearisation point of a Newton step, for all particles of the model.
template <class Real>
struct NewtonPoint {
  const Vec3Array<Real>& x;  ///< [m]
  const Vec3Array<Real>& v;  ///< [m/s]
  Real rate;                 ///< derivative of velocities by positions [1/s]
  /// Contribution of inertia and damping to the matrix per particle, times the unit matrix [N/m].
  const std::vector<Real>& inertia;
  /// Contribution of the air; null without air [N/m].
  const std::vector<SymmetricBlock<Real>>* air;
};

/// The linear systems of a cloth that is a whole grid with regular springs and bends by the
/// quadratic form or not at all: vector code, multigrid.
template <class Real>
class GridSystem {
 public:
  static bool fits(const ClothModel<Real>& model, const ClothPart<Real>& part);

  GridSystem(const ClothModel<Real>& model, const ClothPart<Real>& part);

  /// Number of values in a vector, including the zeros between them.
  std::size_t size() const { return grid().layout.size(); }
  /// Indices of a particle's components; the particle is counted from the part's first.
  std::array<std::size_t, 3> places(Index particle) const;

  /// Sets the pinned particles.
  void set_pinned(const std::vector<Real>& inverse_mass);

  /// Adds the forces of springs and bending to `force`, and stores the matrix.
  void linearise(const ClothModel<Real>&, const NewtonPoint<Real>& at, Vec3Array<Real>& force);

  void load(const Vec3Array<Real>& from, Real* to) const;
  void add(const Real* from, Vec3Array<Real>& to) const;

  void apply(const Real* p, Real* y) const { multiply(grid(), p, y); }
  void precondition(const Real* r, Real* z) { multigrid_.precondition(r, z); }
  LinearEffort effort() const { return {}; }

 private:
  const SpringGrid<Real>& grid() const { return multigrid_.finest(); }

  Multigrid<Real> multigrid_;
  SpringPlanes<Real> springs_;
  IndexRange particles_;
  GridVector<Real> x_, v_, force_;  ///< scratch of `linearise`
};

}  // namespace weft
