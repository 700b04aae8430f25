#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/solver/implicit/block_factor.h"
#include "core/solver/implicit/grid_system.h"
#include "core/solver/implicit/linear_terms.h"
#include "core/solver/implicit/membrane_term.h"
#include "core/types.h"

// Linear systems of meshes and other cloths without a regular grid.

namespace weft {

/// The linear systems of cloths other than regular grids, element by element, preconditioned by the
/// factors of the matrix where they are worth their cost, otherwise by the inverse of the diagonal
/// blocks. A hinge's matrix is k g g^T with g the gradient of its angle (Gauss-Newton: the
/// curvature of the angle itself may be indefinite). Rest curves have forces but no matrix: the
/// links' holds most of the second derivatives of their energy.
template <class Real>
class ElementSystem {
 public:
  ElementSystem(const ClothModel<Real>& model, const ClothPart<Real>& part);

  std::size_t size() const { return size_; }
  std::array<std::size_t, 3> places(Index particle) const {
    const auto at = 3 * static_cast<std::size_t>(particle);
    return {at, at + 1, at + 2};
  }

  /// Sets the pinned particles, for a tick. Factors of earlier ticks are forgotten, so that a tick
  /// depends on nothing but its start.
  void set_pinned(const std::vector<Real>& inverse_mass);
  void linearise(const ClothModel<Real>& model, const NewtonPoint<Real>& point,
                 Vec3Array<Real>& force);
  void load(const Vec3Array<Real>& from, Real* to) const;
  void add(const Real* from, Vec3Array<Real>& to) const;
  void apply(const Real* p, Real* y) const;
  void precondition(const Real* r, Real* z);
  LinearEffort effort() const {
    return factored_ ? LinearEffort{} : LinearEffort{kDiagonalTolerance, kMostDiagonalIterations};
  }

 private:
  /// Energy stiffness/2 |sum_k weight_k x_k|^2.
  struct Stencil {
    Index x[4] = {0, 0, 0, 0};
    Real weight[4] = {0, 0, 0, 0};
    int count = 0;
    Real stiffness = 0;
  };
  struct HingeTerm {
    Index x[4];
    std::array<Vec3<Real>, 4> gradient;
    Real stiffness;
  };

  struct MembraneElement {
    MembraneTriangle<Real> triangle;  ///< particles counted from the part's first
    MembraneTerm<Real> term;
  };

  std::size_t products() const;
  void prepare_factor(const ClothModel<Real>& model);
  void factor();
  template <class Visitor>
  void visit_blocks(Visitor&& visit) const;
  void linearise_membrane(const NewtonPoint<Real>& point, Vec3Array<Real>& force);

  std::size_t number_;  ///< of the part
  IndexRange particles_, springs_, hinges_;
  MembraneTensor<Real> tensor_;
  std::vector<MembraneElement> membrane_;
  std::size_t size_ = 0;  ///< a multiple of kGridMargin
  std::vector<std::array<Index, 2>> ends_;
  std::vector<SymmetricBlock<Real>> blocks_;
  std::vector<Stencil> stencils_;
  std::vector<HingeTerm> hinge_terms_;
  std::vector<SymmetricBlock<Real>> own_, diagonal_, inverse_;
  std::vector<Real> free_;
  BlockFactor factor_;                    ///< empty if it costs more than it saves
  bool factored_ = false;                 ///< it holds the factors of a matrix of this tick
  std::size_t uses_ = 0;                  ///< of these factors
  std::vector<BlockFactor::Slot> slots_;  ///< see visit_blocks
};

}  // namespace weft
