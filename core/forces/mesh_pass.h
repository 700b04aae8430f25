#pragma once

#include <array>
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
  /// Lists the neighbours. A part whose springs are not all damped in proportion to their
  /// stiffness, with more than 64 springs at a particle or with neighbours more than 32 thousand
  /// particles apart does not fit and stays with the element-wise form.
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
  };
  /// Neighbours of a particle: those that it has a spring with, and those it only bends with.
  struct Row {
    std::vector<Link> near, far;
  };
  using Rows = std::vector<Row>;  // by particle of the part
  using Members = std::array<std::size_t, kMeshGroup>;

  static bool collect_springs(const ClothModel<Real>& model, const ClothPart<Real>& part,
                              Real damping_per_stiffness, Rows& rows);
  static void collect_bending(const ClothPart<Real>& part, Rows& rows);
  void lay_out(const Rows& rows);
  void add_group(const Rows& rows, const Members& members, std::size_t block);

  MeshView<Real> view_;
  std::vector<MeshGroup> groups_;
  std::vector<MeshWay> ways_;
  AlignedVector<Real> numbers_;
  std::vector<std::uint8_t> places_;
  bool in_reach_ = true;  // every neighbour is a MeshWay off
};

}  // namespace weft
