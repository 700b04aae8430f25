#pragma once

#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/forces/kick.h"
#include "core/forces/mesh_view.h"
#include "core/forces/triangle_pairs.h"
#include "core/math/aligned_vector.h"
#include "core/types.h"

// Forces of a mesh by gathering, in vector code.

namespace weft {

/// Forces of springs or membrane triangles, dashpots and quadratic bending of one part of the
/// model, by gathering: each particle sums the pulls of its later neighbours, and takes those that
/// earlier ones and triangles have computed. No particular order of particles is needed, so the
/// part need not be a grid.
template <class Real>
class MeshPass {
 public:
  /// Lists the neighbours. A part does not fit, and keeps the element-wise form, if its springs are
  /// not damped in proportion to stiffness, if a particle has more than kMostSpringsAtParticle
  /// springs or pairs of triangles, or if neighbours are some thousand particles apart.
  void prepare(const ClothModel<Real>& model, const ClothPart<Real>& part);

  bool fits() const { return view_.count > 0; }

  /// Overwrites the part's range of `force` [N].
  /// @param x,v  of all particles [m], [m/s]
  void compute_forces(const Vec3Array<Real>& x, const Vec3Array<Real>& v, Vec3Array<Real>& force);

  /// Kicks the part's range of `v` by the forces, without a list of them.
  /// @param particles   from the model's first particle on
  /// @param since_last  time since the last kick [s], if `x` has drifted for it: the rates of the
  ///                    triangles' strains are then their differences since that kick, which match
  ///                    the velocities of the drift; 0: the rates follow from `v`
  void kick(const KickLaw<Real>& law, const KickedParticles<Real>& particles,
            const Vec3Array<Real>& x, Vec3Array<Real>& v, Real since_last);

  /// Size of the arrays [B].
  std::size_t bytes() const;

 private:
  struct Link {
    Index neighbour = 0;
    Real rest_length = 0, stiffness = 0;
    double bending_weight = 0;
  };
  using Pairs = std::vector<TrianglePair<Real>>;
  /// Later neighbours of a particle: those joined by a spring, and those joined only by bending.
  struct Row {
    std::vector<Link> near, far;
    std::size_t pulled_by = 0;         ///< number of pairs of triangles and earlier neighbours
    std::vector<std::size_t> earlier;  ///< their pulls, numbered over the whole mesh
  };
  using Rows = std::vector<Row>;  // by particle of the part
  using Members = std::vector<std::size_t>;

  static bool collect_springs(const ClothModel<Real>& model, const ClothPart<Real>& part,
                              Real damping_per_stiffness, Rows& rows);
  static bool count_pairs(const Pairs& pairs, const ClothPart<Real>& part, Rows& rows);
  static void collect_bending(const ClothPart<Real>& part, Rows& rows);
  static void sort_block(const Rows& rows, Members& block);
  std::uint8_t stored_slots(std::size_t slots);
  void add_group(Rows& rows, const Members& members, std::size_t block);
  void give_links(Rows& rows, Pairs& pairs) const;
  void add_pairs(const Pairs& pairs, std::size_t block, Rows& rows);
  std::vector<Members> lay_out(const Pairs& pairs, Rows& rows);
  void list_pulls(const Rows& rows, const std::vector<Members>& groups);
  void point_view();

  MeshView<Real> view_;
  std::vector<MeshPairs> pairs_;
  std::vector<MeshOffset> corners_;
  std::vector<MeshGroup> groups_;
  std::vector<MeshOffset> offsets_;
  AlignedVector<Real> numbers_, shapes_, links_, strains_, ring_;
  std::vector<std::uint16_t> pulls_;
  std::size_t pull_count_ = 0;  // lanes of slots laid out so far
  bool bends_ = false;          // pairs have links
  std::size_t listed_ = 0;      // pairs laid out so far
  bool in_reach_ = true;        // every neighbour is within a MeshOffset, every count in its 8 bits
};

}  // namespace weft
