#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/colliders/collider_frame.h"
#include "core/contact/objects/analytic_shapes.h"
#include "core/contact/objects/cloth_patches.h"
#include "core/contact/objects/contact_log.h"
#include "core/contact/objects/contact_parts.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/corners.h"
#include "core/contact/objects/feature_distance.h"
#include "core/contact/objects/lone_rows.h"
#include "core/contact/objects/mesh_shape.h"
#include "core/executor.h"
#include "core/profile.h"

// Contact of cloths with objects, at rest or moving; section 4 of core/README.md is an overview.

namespace weft {

template <class Real>
class ClothGuard;

/// Three nested lists, each valid while no particle has moved farther than its allowance:
/// clearances (nothing near), candidates (pairs within reach for about a tick), rows (planes frozen
/// for a few substeps). Rows are solved on velocities between kick and drift, with Coulomb friction
/// that sticks; a particle that would still cross a plane does not move, whatever pulls at it.
/// The planes of a moving object go with it. What it meets gives way or is carried along; where it
/// cannot, the object stands still for some substeps.
template <class Real>
class Contact {
 public:
  Contact() = default;

  /// @param cloths        settings of each cloth, in the order of their particles; at least one
  /// @param patches       the features of all cloths
  /// @param executor      runs the collection in chunks; may be null
  /// Throws DefinitionError if a collider is out of range.
  Contact(const std::vector<ContactDef>& cloths, const std::vector<ColliderDef>& colliders,
          ClothPatches patches, Executor* executor);

  /// Forgets everything about where the cloth is.
  void reset();

  /// @param tick_seconds  length of the tick [s]
  /// @param colliders     as planned for the tick, in the order of their definitions; moved on in
  ///                      each `resolve` of it. Null: all stand as defined.
  void begin_tick(double tick_seconds, ColliderStates* colliders = nullptr);

  /// Puts the shapes where the colliders are.
  void place(const ColliderStates& colliders);

  /// Work of moving objects on the cloth in this tick [J].
  double work() const { return work_; }

  /// Says that planes are not valid: masses changed (a pin), or the cloth was put elsewhere.
  void invalidate_rows() { rows_built_ = false; }

  /// Says that which cloths sleep has changed: their particles meet nothing, and it is the caller's
  /// to wake what an object will meet.
  void let_rest(const ClothState<Real>& state);

  /// Before a kick, notes the velocities with which everybody has moved: what bounces comes with
  /// them. Without, a bounce asks for the velocities after the kick alone.
  void note_motion(const ClothState<Real>& state);
  /// After the kick and before any impulse of contact, that of cloths on each other too, notes the
  /// velocities. Without, `resolve` and `settle` take those that they find for them.
  void note_kicked(const ClothState<Real>& state);

  /// Makes the velocities admissible for the coming drift of `dt` [s], in which objects move as
  /// planned. Positions change only by pushing out what is nearer than the thickness, slowly and
  /// without giving it velocity. `move_objects` must follow.
  /// @param guard  of the cloths, whose rows are swept in turn with these, and again while either
  ///               still changes velocities much; null: none
  void resolve(ClothState<Real>& state, Real dt, Profile& profile,
               ClothGuard<Real>* guard = nullptr);

  /// How far every particle may go from where it is with nothing that it could meet [m]; 0 if
  /// something is near or moves.
  Real calm_room(const ClothState<Real>& state) const;

  /// Right before the drift: moves the objects on. Where somebody has been stopped since `resolve`
  /// before one that comes, it stands still; and where that is not enough, as others follow it, all
  /// do.
  /// @param truncated  whether anybody may have been stopped since
  /// @return false if all had to stand still, wherever they wanted to go
  bool move_objects(ClothState<Real>& state, Real dt, bool truncated);

  /// Makes the velocities at the end of a tick admissible.
  /// @param guard  as above
  void settle(ClothState<Real>& state, Real dt, Profile& profile,
              ClothGuard<Real>* guard = nullptr);

  /// Deepest point of the cloth inside an object [m], 0 if there is none: particles, and points at
  /// each quarter of the edges. Does not use the lists above.
  double deepest_penetration(const Vec3Array<Real>& x) const;

  const std::vector<ContactRow<Real>>& rows() const { return rows_; }
  /// Distance of a row's point of the cloth from the row's object where both are now [m]; from its
  /// plane, if the object has no inside.
  Real gap_of(const ContactRow<Real>& row, const Vec3Array<Real>& x) const;
  /// Whether any point of the cloth touches an object now.
  bool touches(const Vec3Array<Real>& x) const;
  /// Cloths that are inside objects because they started there.
  const std::vector<BadStart<Real>>& bad_starts() const { return exits_; }

  /// Notes the impulses of each tick from now on, or no longer: see ContactLog::want.
  void log_impulses(bool contacts, bool each) { log_.want(contacts, each); }

  /// Impulses of the present tick, if noted, and a collider's motion in the present substep.
  const ContactLog& log() const { return log_; }
  const ColliderFrame<Real>& frame(std::size_t collider) const { return frames_[collider]; }

  /// Contacts of the last tick with their mean forces over it, if impulses are noted [N]; without
  /// forces if not. Those that pushed, and those that touch now.
  std::vector<ContactPoint> contacts(const Vec3Array<Real>& x);

 private:
  using Plane = ObjectPlane<Real>;
  using Ball = ObjectBall<Real>;
  using Rod = ObjectRod<Real>;
  using Round = RoundObject<Real>;
  using Pairs = std::vector<ContactCandidate<Real>>;
  using Barrier = ContactBarrier<Real>;
  using Look = ContactLook<Real>;
  using Measure = void (*)(const FeatureTable<Real>&);
  /// Features of a cloth's patch, or of a mesh near it, as rows or columns of a FeatureTable.
  struct Features {
    std::vector<Index> number;
    std::vector<Real> values;
    std::vector<Real> reach2;       ///< of the cloth's: how near the other of a pair is [m^2]
    std::vector<Real> rounding;     ///< by which distances may come out too large [m]
    std::vector<Aabb<Real>> boxes;  ///< of the cloth's
    Aabb<Real> around;              ///< the reach of all

    void clear();
    void add(Index feature, Real reach, Real error, const Aabb<Real>& box,
             std::initializer_list<Vec3<Real>> vectors);
  };
  /// What a mesh has about a patch of the cloth; serves until the patch leaves the box.
  struct Neighbourhood {
    Aabb<Real> box;
    Features triangles, edges, vertices;
  };
  /// What a chunk of the collection finds, and room to work.
  struct Found {
    Pairs particle_pairs, edge_pairs, triangle_pairs;
    std::uint64_t tests = 0;
    Features particles, edges, triangles;
    std::vector<Real> distance2;
  };
  /// Who is inside what, when the rows are built: number of the collider.
  static constexpr Index kOutside = -1, kInsideSeveral = -2;
  static constexpr int kChunks = 8;
  /// A particle that is pushed out may go so much farther than its reach; more than a push does
  /// [part of the thickness].
  static constexpr double kRoomForPush = 0.125;
  /// Push-out: part of the lack taken each substep, and its largest speed [m/s].
  static constexpr double kPushOutPart = 0.1, kPushOutSpeed = 0.5;

  bool empty() const {
    return planes_.empty() && balls_.empty() && rods_.empty() && meshes_.empty();
  }
  void add_shape(const ShapeDef& shape, std::size_t collider);

  // contact_collect.cpp
  void collect(const ClothState<Real>& state, Real dt, Profile& profile);
  void measure_clearance(const ClothState<Real>& state, Real dt, Profile& profile);
  void mark_near(const ClothState<Real>& state);
  bool renew_clear(const ClothState<Real>& state, Real dt, Profile& profile);
  bool renew_clearance(const ClothState<Real>& state, std::size_t i, Real dt);
  Real wanted_skin(const ClothState<Real>& state, std::size_t i, Real dt) const;
  Real analytic_clearance(const Vec3<Real>& p, Real reach) const;
  Real clearance(const Vec3<Real>& p, Real reach) const;
  Real least_clearance(const Vec3<Real>& p, Real reach) const;
  Real signed_distance(const Vec3<Real>& p) const;

  // contact_pairs.cpp
  void collect_pairs(const ClothState<Real>& state, Profile& profile);
  void mark_paired();
  void join_found(std::size_t mesh, Profile& profile);
  void load_particles(const MeshShape<Real>& mesh, const NearPatch& near, const Vec3Array<Real>& x,
                      Features& into);
  void load_edges(const MeshShape<Real>& mesh, const NearPatch& near, const Vec3Array<Real>& x,
                  Features& into);
  void load_triangles(const NearPatch& near, const Vec3Array<Real>& x, Features& into);
  void load_mesh(const MeshShape<Real>& mesh, Neighbourhood& about) const;
  void pair_patch(std::size_t m, const NearPatch& near, const Vec3Array<Real>& x, Found& found);
  FeatureTable<Real> measure_all(const Features& cloth, const Features& mesh, const Aabb<Real>& box,
                                 Measure measure, Found& found, std::vector<Real>& room) const;
  void pair_all(const Features& cloth, const Features& mesh, const Aabb<Real>& box, Measure measure,
                Found& found, Pairs& pairs, std::vector<Real>& room);
  void pair_particles(const MeshShape<Real>& mesh, const Vec3Array<Real>& x,
                      const Neighbourhood& about, Found& found);
  void extend_skins();

  // contact_rows.cpp
  bool rows_hold(const ClothState<Real>& state, Real dt);
  void rebuild_rows(const ClothState<Real>& state, Real dt, Profile& profile);
  void add_particle_rows(const ClothState<Real>& state, Profile& profile);
  std::uint64_t add_mesh_rows(const ClothState<Real>& state, std::size_t m, Index i);
  Corners<Real> corners_of(const ClothState<Real>& state, const Index* first, int count) const;
  void add_edges_on_meshes(const ClothState<Real>& state, Profile& profile);
  void add_triangles_on_meshes(const ClothState<Real>& state, Profile& profile);
  std::optional<Look> look_at(const ClothState<Real>& state, const ContactCandidate<Real>& pair,
                              std::span<const Index> particles, double span, const Rise<Real>& rise,
                              std::size_t collider) const;
  void add_row(const ClothState<Real>& state, std::initializer_list<Index> particles,
               const std::array<Real, 3>& weights, const Barrier& barrier, std::size_t collider,
               bool responds = true);
  double top_of(std::size_t mesh, const Vec3<Real>& normal,
                std::initializer_list<Index> vertices) const;
  void note_inside(Index particle, std::size_t collider);
  bool is_inside(Index particle, std::size_t collider) const;
  bool still_leaves(Index particle, std::size_t collider);
  /// Beyond this distance two features cannot meet while the rows hold [m].
  Real beyond_reach(Real reach) const {
    return reach + smallest_gap_ + thickness_ * Real(kRoomForPush);
  }

  // contact_rounds.cpp
  CornerBound<Real> bound_of(const ClothState<Real>& state, const Index* first, int count) const;
  Real kept_height(Index particle, Real distance) const;
  void measure_cores(const ClothState<Real>& state, const Round& round);
  void add_features_on_rounds(const ClothState<Real>& state, Profile& profile);
  void add_edges_on(const Round& round, const ClothState<Real>& state);
  void add_triangles_on(const Round& round, const ClothState<Real>& state, Profile& profile);

  // contact_exits.cpp
  Real distance_from(std::size_t collider, const Vec3<Real>& p) const;
  void add_inside(const ClothState<Real>& state, Index i, const Vec3<Real>& normal, Real distance,
                  std::size_t collider);
  Vec3<Real> find_way_out(const ClothState<Real>& state, std::size_t collider, Index cloth) const;

  // contact_ways.cpp
  bool measure_way(const ClothState<Real>& state, Real dt);
  bool measure_pushed_way(const ClothState<Real>& state, Real dt);
  void measure_rooms();
  void find_lone_rows(std::size_t particles);
  LonePass<Real> lone_pass(ClothState<Real>& state, Real dt);

  // contact_solve.cpp
  /// Whether no object moves or has moved since the lists were made.
  bool stands_still() const {
    return !any_tracked_ && moving_rows_.empty() && way_rows_ == 0 && way_step_ == 0 && gone_ == 0;
  }
  template <class Visit>
  void for_joint_rows(Visit&& visit) const;
  void find_busy_rows();
  /// How high above a plane who moves must be after the coming drift, who is at a height now [m].
  /// What is nearer than it keeps must not come nearer, rounding included.
  Real least_end(const ContactRow<Real>& row, Real now) const {
    return now < 0 ? now : std::min(now + smallest_gap_ / 16, row.keep);
  }
  void hold_within_reach(ClothState<Real>& state, Real dt);
  void push_out(ClothState<Real>& state, Real dt);
  void aim_rows(const ClothState<Real>& state, Real dt);
  Real sweep_rows(ClothState<Real>& state, std::uint64_t& friction_evaluations, bool again = false);
  void respond(std::size_t r, const Vec3<Real>& v, Real vn, Real push, ClothState<Real>& state,
               std::uint64_t& friction_evaluations);
  void solve_rows(ClothState<Real>& state, Real dt, Profile& profile, ClothGuard<Real>* guard);
  void certify(ClothState<Real>& state, Real dt, bool others);
  bool keep_off(const ContactRow<Real>& row, bool hold, ClothState<Real>& state, Real dt);
  void log_stop(const ContactRow<Real>& row, std::size_t k, const Vec3<Real>& before,
                const ClothState<Real>& state);

  // contact_bounce.cpp
  Vec3<Real> velocity_over(const ContactRow<Real>& row, const Vec3Array<Real>& v) const;
  void note_impact(std::size_t r, const ClothState<Real>& state);
  void bounce(ClothState<Real>& state, Profile& profile, ClothGuard<Real>* guard);

  // contact_grip.cpp
  void share_squeeze(const ClothState<Real>& state, Real dt);
  bool faces(const ContactRow<Real>& row, const ColliderState& jaw) const;

  // contact_movers.cpp
  void place_collider(std::size_t collider, const Pose& pose);
  void stop_overloaded(double dt);
  void plan_colliders(Real dt);
  void move_colliders(Real dt);
  void take_to_own(const Vec3Array<Real>& x);
  const Vec3Array<Real>& in_frame_of(std::size_t mesh, const Vec3Array<Real>& x) const;
  void follow(const ContactRow<Real>& row, double top, std::size_t collider, Real mobility);
  void take_reaction(const ContactRow<Real>& row, const Vec3<Real>& point,
                     const Vec3<Real>& change);
  Real height_after(const ContactRow<Real>& row, const Vec3<Real>& end) const;
  Real lack_behind(const ContactRow<Real>& row, std::size_t i, const ClothState<Real>& state,
                   Real dt) const;
  bool keep_off_mover(const ContactRow<Real>& row, ClothState<Real>& state, Real dt);
  void certify_with_movers(ClothState<Real>& state, Real dt);
  bool hold_or_block(bool carry, ClothState<Real>& state, Real dt);
  bool hold_row(const ContactRow<Real>& row, bool carry, ClothState<Real>& state, Real dt);
  void block(std::size_t collider);
  Real least_height(const ContactRow<Real>& row, bool moves) const;
  void take_back_pushes(ClothState<Real>& state);

  // contact_stops.cpp
  bool find_stopped(const ClothState<Real>& state);
  bool ends_legally(const ContactRow<Real>& row, std::size_t k, const ClothState<Real>& state,
                    Real dt) const;
  bool block_before_stopped(const ClothState<Real>& state, Real dt);
  bool may_stand(const ClothState<Real>& state, Real dt) const;
  void halt(ClothState<Real>& state, Real dt);

  Index cloth_of(Index particle) const;
  Real thickness_of(Index particle) const {
    return static_cast<Real>(cloths_[static_cast<std::size_t>(cloth_of(particle))].thickness);
  }

  std::vector<ContactDef> cloths_;
  Real thickness_ = 0;     ///< the largest of all cloths, for reaches [m]
  Real smallest_gap_ = 0;  ///< that is left between cloth and objects after every step [m]
  Executor* executor_ = nullptr;
  ClothPatches patches_;
  std::vector<Plane> planes_;
  std::vector<Ball> balls_;
  std::vector<Rod> rods_;
  std::vector<MeshShape<Real>> meshes_;
  std::vector<std::size_t> mesh_collider_;  ///< the collider of each mesh
  Real widest_skin_ =
      std::numeric_limits<Real>::infinity();  ///< about a triangle of the meshes [m]

  Real tick_seconds_ = 0;
  bool collected_ = false, rows_built_ = false;
  std::vector<char> resting_;  ///< 1 for each particle of a cloth that sleeps; empty if none does
  Vec3Array<Real> x_collected_, x_rows_;
  std::vector<Real> clearance_;        ///< lower bound of each particle's distance from all objects
  std::vector<Real> fresh_clearance_;  ///< the same, while pairs are collected
  std::vector<char> has_pairs_;
  std::size_t collections_ = 0;
  /// How far each of the near features may go before it can touch what it has no pair with [m].
  std::vector<Real> particle_room_, edge_room_, triangle_room_;
  std::vector<Real> skin_;       ///< how far each may move before the next collection
  std::vector<Real> moved_;      ///< of each since the collection, when the rows are built [m]
  std::vector<Real> row_reach_;  ///< how far each may move before the next rows
  std::vector<Real> gap_;        ///< of each from all meshes when the rows are built, at least [m]
  std::vector<Real> span_;       ///< how far a feature's points may be from its nearest corner [m]
  std::vector<char> near_, active_;  ///< near an object; near, or joined to one that is
  std::vector<char> paired_;         ///< in a candidate pair, or near an analytic shape
  std::vector<Index> active_particles_, near_edges_, near_triangles_;
  std::vector<NearPatch> near_patches_;                     ///< ranges of those three lists
  std::vector<std::vector<Neighbourhood>> neighbourhoods_;  ///< of each mesh, for each patch
  std::vector<Pairs> particle_pairs_, edge_pairs_, triangle_pairs_;
  std::array<Found, kChunks> found_;
  std::vector<std::size_t> cursor_;  ///< place in each mesh's particle pairs while rows are built
  std::vector<MeshDistance<Real>>
      nearby_;  ///< triangles near one particle, while its rows are built
  std::vector<CornerBound<Real>> edge_bounds_,
      triangle_bounds_;  ///< of the near ones, while rows are built
  /// Distance of active particles from the core of a round object, and what they keep of it [m].
  std::vector<Real> core_, least_core_;
  std::vector<Index> inside_;  ///< of each particle the collider that it is inside of
  std::vector<BadStart<Real>> exits_;
  std::vector<ContactRow<Real>> rows_;
  std::vector<Real> travel2_;             ///< see measure_way [m^2]
  std::vector<RowRoom<Real>> rooms_;      ///< of the rows
  std::vector<std::size_t> busy_rows_;    ///< rows that can respond in this step
  std::vector<std::size_t> pushed_rows_;  ///< those that have, some more than once
  bool bounces_ = false;                  ///< a cloth has restitution
  Vec3Array<Real> v_came_, v_kicked_;     ///< of this step, as noted; empty if not [m/s]
  std::vector<Impact<Real>> impacts_;     ///< of this step
  LoneRows<Real> lone_rows_;              ///< those that know of no other one
  std::vector<std::size_t> joint_rows_;   ///< all others
  LoneResponse<Real> lone_response_;      ///< of this step, before others respond
  bool lone_apart_ = false;  ///< in this step lone rows are worked on apart, all at once

  std::vector<Plane> own_planes_;  ///< as defined
  std::vector<Ball> own_balls_;
  std::vector<Rod> own_rods_;
  std::vector<ColliderFrame<Real>> frames_;  ///< of each collider
  ColliderStates* colliders_ = nullptr;      ///< of the tick under way
  bool any_tracked_ = false;                 ///< whether one of them moves in this tick
  bool any_jaw_ = false;                     ///< whether one of them is a gripper's
  bool first_substep_ = true;                ///< of the tick
  Real surface_speed_ = 0;                   ///< of the fastest [m/s]
  Real gone_ = 0;      ///< longest way of an object since the pairs were collected [m]
  Real way_rows_ = 0;  ///< since the rows were built, and in the coming substep [m]
  Real way_step_ = 0;  ///< in the coming substep alone [m]
  std::vector<Vec3Array<Real>> x_own_;  ///< active particles in the frame of each mesh
  std::vector<MovingRow<Real>> moving_rows_;
  Vec3Array<Real> x_unpushed_;  ///< before the push-out
  /// As certified, while objects move: whoever is elsewhere then was stopped by somebody else.
  Vec3Array<Real> x_certified_, v_certified_;
  std::vector<char> is_stopped_;
  double work_ = 0;
  ContactLog log_;
};

extern template class Contact<float>;
extern template class Contact<double>;

}  // namespace weft
