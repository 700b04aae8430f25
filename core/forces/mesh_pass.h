#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/forces/mesh_view.h"
#include "core/math/aligned_vector.h"
#include "core/types.h"

namespace weft {

/// Springs, dashpots and quadratic bending of one part of the model by gathering: each particle
/// adds up what its neighbours do to it, each spring is evaluated from both ends (NUMERICS.md a).
/// No order of particles matters, so the part need not be a grid.
template <class Real>
class MeshPass {
 public:
  /// Lists the neighbours. A part whose springs are not all damped in proportion to their stiffness
  /// does not fit and stays with the element-wise form.
  void prepare(const ClothModel<Real>& model, const ClothPart<Real>& part);

  bool fits() const { return view_.count > 0; }

  /// Overwrites the part's stretch of `force` [N].
  /// @param x,v  of all particles [m], [m/s]
  void compute_forces(const Vec3Array<Real>& x, const Vec3Array<Real>& v, Vec3Array<Real>& force);

  /// What the arrays take [B].
  std::size_t bytes() const;

 private:
  struct Link {
    Index neighbour = 0;
    Real rest_length = 0, stiffness = 0;
    double bending_weight = 0;
    bool is_spring = false;
  };
  using Links = std::vector<std::vector<Link>>;  // by particle of the part

  static bool collect_springs(const ClothModel<Real>& model, const ClothPart<Real>& part,
                              Real damping_per_stiffness, Links& links);
  static void collect_bending(const ClothPart<Real>& part, Links& links);
  void lay_out(const Links& links, Index first);

  MeshView<Real> view_;
  std::vector<MeshBlock<Real>> blocks_;
  std::vector<Index> neighbour_;
  std::vector<Real> rest_length_, stiffness_, bending_weight_;
  AlignedVector<Real> gathered_;
};

}  // namespace weft
