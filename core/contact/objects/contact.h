#pragma once

#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/objects/clearance.h"
#include "core/contact/objects/contact_cloths.h"
#include "core/contact/objects/contact_log.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/mover_stops.h"
#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_pairs.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/objects/object_shapes.h"
#include "core/contact/objects/row_response.h"
#include "core/executor.h"
#include "core/profile.h"

// Contact of cloths with objects, at rest or moving; section 4 of core/README.md is an overview.

namespace weft {

template <class Real>
class ClothGuard;

/// Three nested lists, each valid while no particle has moved farther than its allowance:
/// clearances (clearance.h), candidates within reach for about a tick (object_pairs.h), rows, which
/// are planes frozen for a few substeps (object_rows.h). Rows are solved on velocities between kick
/// and drift, with Coulomb friction that sticks (row_response.h); a particle that would still cross
/// a plane does not move, whatever pulls at it (object_certificate.h). The planes of a moving
/// object go with it. What it meets yields or is carried along; where it cannot, the object stands
/// still for some substeps (mover_stops.h).
///
/// This class owns the state of all these, and calls them in their order.
template <class Real>
class Contact {
 public:
  Contact() = default;

  /// @param cloths        settings of each cloth, in the order of their particles; at least one
  /// @param patches       the features of all cloths
  /// @param executor      runs the collection in parts; may be null
  /// @param store         has prepared meshes; may be null
  /// Throws DefinitionError if a collider is out of range.
  Contact(const std::vector<ContactDef>& cloths, const std::vector<ColliderDef>& colliders,
          ClothPatches patches, Executor* executor, MeshStore* store);

  /// Forgets everything about where the cloth is.
  void reset();

  /// @param tick_seconds  length of the tick [s]
  /// @param colliders     as planned for the tick, in the order of their definitions; moved on in
  ///                      each `resolve` of it. Null: all stand as defined.
  void begin_tick(double tick_seconds, ColliderStates* colliders = nullptr);

  /// Puts the shapes where the colliders are.
  void place(const ColliderStates& colliders);

  /// Work of moving objects on the cloth in this tick [J].
  double work() const { return motion_.work; }

  /// Says that planes are not valid: masses changed (a pin), or the cloth was put elsewhere.
  void invalidate_rows() { reach_.made = false; }

  /// Says that which cloths sleep has changed: their particles meet nothing, and the caller has to
  /// wake what an object will meet.
  void let_rest(const ClothState<Real>& state);

  /// Before a kick, notes the velocities of the last drift: what bounces comes with them. Without,
  /// a bounce asks for the velocities after the kick alone.
  void note_motion(const ClothState<Real>& state);
  /// After the kick and before any impulse of contact, that of cloths on each other too, notes the
  /// velocities. Without, `resolve` and `settle` take those that they find for them.
  /// @param force_ratio  see Collision::before_drift
  void note_kicked(const ClothState<Real>& state, double force_ratio = 1);

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

  /// Right before the drift: moves the objects on. Where a particle has been stopped since
  /// `resolve` before one that comes, it stands still; and where that is not enough, as others
  /// follow it, all do.
  /// @param truncated  whether any particle may have been stopped since
  /// @return false if all had to stand still, wherever they wanted to go
  bool move_objects(ClothState<Real>& state, Real dt, bool truncated);

  /// Makes the velocities at the end of a tick admissible.
  /// @param guard  as above
  void settle(ClothState<Real>& state, Real dt, Profile& profile,
              ClothGuard<Real>* guard = nullptr);

  /// Deepest point of the cloth inside an object [m], 0 if there is none: particles, and points at
  /// each quarter of the edges. Does not use the lists above.
  double deepest_penetration(const Vec3Array<Real>& x) const;

  const std::vector<ContactRow<Real>>& rows() const { return rows_.all; }

  /// Calls visit(particle) for what jaws that stand hold in this substep.
  void for_each_held(auto&& visit) const {
    for (const MovingRow<Real>& moving : rows_.moving) {
      if (moving.grip == 0 || shapes_.frames[moving.collider].moves) continue;
      const ContactRow<Real>& row = rows_.all[moving.row];
      for (std::size_t k = 0; k < row.count; ++k) visit(row.particle[k]);
    }
  }
  /// Distance of a row's point of the cloth from the row's object where both are now [m]; from its
  /// plane, if the object has no inside.
  Real gap_of(const ContactRow<Real>& row, const Vec3Array<Real>& x) const;
  /// Whether any point of the cloth touches an object now.
  bool touches(const Vec3Array<Real>& x) const;
  /// Cloths that are inside objects because they started there.
  const std::vector<BadStart<Real>>& bad_starts() const { return rows_.exits; }

  /// Notes the impulses of each tick from now on, or no longer: see ContactLog::want.
  void log_impulses(bool contacts, bool each) { log_.want(contacts, each); }

  /// Impulses of the present tick, if noted, and a collider's motion in the present substep.
  const ContactLog& log() const { return log_; }
  const ColliderFrame<Real>& frame(std::size_t collider) const { return shapes_.frames[collider]; }

  /// Contacts of the last tick with their mean forces over it, if impulses are noted [N]; without
  /// forces if not. Those that pushed, and those that touch now.
  std::vector<ContactPoint> contacts(const Vec3Array<Real>& x);

 private:
  ObjectSolve<Real> solving(ClothState<Real>& state) {
    return {cloths_, rows_, response_, bounces_, motion_, reach_, log_, pinches_, executor_, state};
  }
  void collect(const ClothState<Real>& state, Real dt, Profile& profile);
  bool renew_clear(const ClothState<Real>& state, Real dt, Profile& profile);
  void rebuild_rows(const ClothState<Real>& state, Real dt, Profile& profile);
  void certify_drift(ClothState<Real>& state, Real dt, bool others);

  Executor* executor_ = nullptr;
  ContactCloths<Real> cloths_;
  ObjectShapes<Real> shapes_;
  ObjectMotion<Real> motion_;
  // Detect.
  Clearance<Real> clearance_;
  NearFeatures<Real> near_;
  ObjectPairs<Real> pairs_;
  // Solve and certify.
  RowScratch<Real> scratch_;
  RowReach<Real> reach_;
  ObjectRows<Real> rows_;
  RowResponse<Real> response_;
  Pinches pinches_;
  Bounces<Real> bounces_;
  MoverStops<Real> stops_;
  /// `resolve` was called for the coming drift, and `move_objects` not yet.
  bool resolved_ = false;
  bool settled_ = true;  ///< the last tick has been settled, and nothing resolved since

  ContactLog log_;
};

extern template class Contact<float>;
extern template class Contact<double>;

}  // namespace weft
