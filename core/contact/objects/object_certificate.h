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
/// @return whether all stay within their reach
template <class Real>
bool measure_travel(const ClothState<Real>& state, Real dt, Executor* executor,
                    RowReach<Real>& reach);

/// Whether the rows hold through the coming drift.
template <class Real>
bool rows_hold(const ClothState<Real>& state, Real dt, const ObjectMotion<Real>& motion,
               const ObjectRows<Real>& rows, Executor* executor, RowReach<Real>& reach);

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

/// Notes the impulse by which the certificate stopped particle k of a row.
/// @param before  its velocity until then [m/s]
template <class Real>
void log_stop(ObjectCertificate<Real>& c, const ContactRow<Real>& row, std::size_t k,
              const Vec3<Real>& before);

}  // namespace weft
