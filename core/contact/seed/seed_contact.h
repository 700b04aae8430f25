#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/colliders/collider_frame.h"
#include "core/contact/seed/seed_equations.h"
#include "core/contact/seed/seed_shape.h"
#include "core/geometry/cloth_trees.h"
#include "core/profile.h"

// The contact model of the seed.

namespace weft {

/// Contact of cloths with themselves and each other.
enum class SelfContact {
  automatic,  ///< the guard with Weft's contact, none with the seed's
  none,
  particles,            ///< particle pairs, eq. (11)
  triangles,            ///< particle-triangle pairs, eq. (12)
  triangles_and_edges,  ///< also edge-edge pairs, which the seed lacked
  guard,                ///< not the seed's: safe regions (cloth_guard.h), nothing crosses
};

/// Feature pairs between cloth and objects.
enum class ObjectContact {
  particles,            ///< eqs. (7) to (10)
  particles_and_edges,  ///< also edges of the cloth against sharp edges of meshes
};

/// Treatment of particles behind the surface of an object.
enum class Correction {
  projection,  ///< eq. (9): onto the surface; flattens folds
  fold_map,    ///< lifts all nearby particles by a monotone map of their distance; keeps folds
};

/// Settings of the seed's contact. Thickness h, friction k_f and dissipation k_diss are those of
/// the fabric.
struct SeedContactDef {
  SelfContact self = SelfContact::automatic;  ///< automatic means none here
  ObjectContact objects = ObjectContact::particles;
  Correction correction = Correction::projection;
  double lift = 0;           ///< eps: distance from the surface after correction [m]; 0 is eq. (9)
  double fold_depth = 0.02;  ///< tau: nearer particles are lifted together [m]
  int passes = 1;            ///< over all pairs of self-contact, per substep

  bool has_self_contact() const {
    return self != SelfContact::automatic && self != SelfContact::none;
  }
};

/// The words of SelfContact.
inline FieldInfo self_contact_info() {
  return choice("self", "automatic|none|particles|triangles|triangles_and_edges|guard",
                "cloth against itself and other cloths; automatic: the guard, or none with the "
                "seed's contact");
}

/// Passes each field to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_seed_contact(Def& c, Visitor&& visit) {
  visit(self_contact_info(), c.self);
  visit(choice("objects", "particles|particles_and_edges", "pairs of the cloth with objects"),
        c.objects);
  visit(choice("correction", "projection|fold_map", "correction of penetration"), c.correction);
  visit(FieldInfo{"lift", 0, 0.1, "m", "distance from the surface after correction"}, c.lift);
  visit(FieldInfo{"fold_depth", 1e-3, 1, "m", "layer that the fold map keeps in order"},
        c.fold_depth);
  visit(FieldInfo{"passes", 1, 100, "", "passes over the pairs of self-contact per substep"},
        c.passes);
}

/// Contact of the seed: proximity at the present instant, found by its trees; impulses on
/// velocities and corrections of positions. It promises nothing: a particle that moves farther than
/// the thickness within a substep passes through.
template <class Real>
class SeedContact {
 public:
  SeedContact() = default;

  /// Throws DefinitionError if a collider is out of range.
  SeedContact(const SeedContactDef& def, const ClothModel<Real>& model,
              const std::vector<ColliderDef>& colliders);

  /// @param tick_seconds  length of the tick [s]
  /// @param colliders     as planned for the tick; advanced in each `collide` of it
  void begin_tick(double tick_seconds, ColliderStates* colliders);

  /// Self-collision, before the particles move: removes the approach of near pairs from the
  /// velocities, eqs. (11) and (12).
  void separate(ClothState<Real>& state, Profile& profile);

  /// Contact with objects, after the particles have moved by v dt: eqs. (7) to (10) and the
  /// correction.
  void collide(ClothState<Real>& state, Real dt, Profile& profile);

  /// Whether anything has touched since the tick began.
  bool touches() const { return touches_; }

 private:
  /// The nearest object surface of a particle.
  struct Nearest {
    Real distance;      ///< signed; at least the reach if nothing is near [m]
    Vec3<Real> normal;  ///< unit, to the side where the particle belongs
    Index object;
  };

  /// Two nearby features of the cloth: two particles, a particle and a triangle, or two edges.
  /// Found once per substep, since impulses move nothing.
  struct SelfPair {
    std::array<Index, 4> particle;
    std::array<Real, 4> weight;  ///< positive on the side that the normal points to; sum 0
    Vec3<Real> normal;           ///< unit
  };

  // seed_self.cpp
  bool are_neighbours(Index i, Index j) const;
  Real thickness_between(Index i, Index j) const;
  void prepare_self_contact();
  std::uint64_t find_particle_pairs(const Vec3Array<Real>& x);
  std::uint64_t find_triangle_pairs(const Vec3Array<Real>& x);
  std::uint64_t find_edge_pairs(const Vec3Array<Real>& x);
  void take_approach(const SelfPair& pair, ClothState<Real>& state);

  // seed_contact.cpp
  void move_colliders(Real dt);
  const Vec3Array<Real>& in_frame_of(std::size_t object, const Vec3Array<Real>& x);
  void find_nearest(const ClothState<Real>& state, Real dt, Profile& profile);
  void offer(std::size_t i, Real distance, const Vec3<Real>& normal, Index object);
  void respond(ClothState<Real>& state);
  std::uint64_t collide_edges(ClothState<Real>& state);

  SeedContactDef def_;
  bool touches_ = false;
  Real reach_ = 0;                            ///< search distance around objects [m]
  std::vector<Index> cloth_of_;               ///< of each particle
  std::vector<Real> thickness_;               ///< h of each cloth [m]
  std::vector<Real> friction_, dissipation_;  ///< k_f, k_diss of each cloth
  Real thickest_ = 0;
  Vec3Array<Real> rest_positions_;
  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  ClothTrees<Real> trees_;
  std::vector<SeedShape<Real>> shapes_;
  std::vector<ColliderFrame<Real>> frames_;  ///< of each shape
  ColliderStates* colliders_ = nullptr;      ///< of the running tick
  double tick_seconds_ = 0;
  Vec3Array<Real> x_own_;  ///< particles in the frame of one shape
  std::vector<Nearest> nearest_;
  std::vector<Real> deepest_;  ///< phi_min of each object [m]
  std::vector<SelfPair> pairs_;
};

extern template class SeedContact<float>;
extern template class SeedContact<double>;

}  // namespace weft
