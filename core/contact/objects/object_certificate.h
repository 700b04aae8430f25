#pragma once

#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/objects/contact_log.h"
#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/objects/object_shapes.h"
#include "core/contact/objects/row_response.h"
#include "core/executor.h"
#include "core/types.h"

// Proof that the coming drift takes no particle through an object: what would cross does not move,
// whatever pulls at it.

namespace weft {

/// Certifying one drift.
template <class Real>
struct ObjectCertificate {
  ObjectShapes<Real>& shapes;  ///< objects before cloth that cannot yield are blocked
  ObjectMotion<Real>& motion;
  const ObjectRows<Real>& rows;
  RowReach<Real>& reach;
  const RowResponse<Real>& response;
  ContactLog& log;
  Executor* executor;
  ClothState<Real>& state;
  Real smallest_gap;  ///< [m]
  Real dt;            ///< of the drift [s]
};

/// Measures how far all particles are from where the rows were made, now or after the coming drift.
/// @param less  what objects have taken of each particle's reach [m]
/// @return whether all stay within the rest of it
template <class Real>
bool measure_travel(const ClothState<Real>& state, Real dt, Real less, Executor* executor,
                    RowReach<Real>& reach);

/// Calls visit(row) for those that particles could cross in the coming drift: the others are
/// farther away than the particles go. Objects that move come nearer, and their rows always count.
template <class Real, class Visit>
void for_near_rows(const ObjectCertificate<Real>& c, Visit&& visit) {
  const std::vector<Real>& travel2 = c.reach.travel2;
  for_joint_rows(c.rows, c.response, [&](std::size_t r) {
    const ContactRow<Real>& row = c.rows.all[r];
    const RowRoom<Real>& room = c.rows.rooms[r];
    if (row.mover != kNone || !(farthest2(room, travel2) < room.cross2)) visit(row);
  });
  if (!c.response.lone_apart) return;
  c.rows.lone.for_each_crossing(travel2.data(), [&](std::size_t r) { visit(c.rows.all[r]); });
}

/// Certifies the coming drift: no particle crosses a plane or goes beyond the reach.
/// @param others  whether anything but rows has changed velocities since all displacements were
///                measured
template <class Real>
void certify(ObjectCertificate<Real>& c, bool others);

/// The certificate where objects move.
template <class Real>
void certify_with_movers(ObjectCertificate<Real>& c);

/// Keeps each particle of a row on its side of the row's plane through the coming drift: as the
/// plane separates two convex features, a particle that ends where it may has not crossed.
/// @param hold  stop a particle that would cross, instead of lifting it along the normal
/// @return whether any had to be kept
template <class Real>
bool keep_off(ObjectCertificate<Real>& c, const ContactRow<Real>& row, bool hold);

/// Tells the impulse by which the certificate stopped particle k of a row.
/// @param before  its velocity until then [m/s]
template <class Real>
void tell_stop(ObjectCertificate<Real>& c, const ContactRow<Real>& row, std::size_t k,
               const Vec3<Real>& before);

}  // namespace weft
