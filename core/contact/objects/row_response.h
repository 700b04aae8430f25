#pragma once

#include <cstdint>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/objects/contact_cloths.h"
#include "core/contact/objects/contact_log.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/lone_rows.h"
#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/objects/pinches.h"
#include "core/executor.h"
#include "core/types.h"

// The contact solver of objects: push-out, projected Gauss-Seidel, friction, restitution.

namespace weft {

template <class Real>
class ClothGuard;

/// A row by which a jaw, or an object that presses, holds a layer.
struct GrippedRow {
  std::size_t moving = 0;  ///< number among the moving rows
  std::size_t other = 0;   ///< the object on the other side of the layer
};

/// Which rows respond in a substep, and what they have done.
template <class Real>
struct RowResponse {
  std::vector<std::size_t> busy;    ///< rows that can respond
  std::vector<std::size_t> pushed;  ///< those that have, some more than once
  bool lone_apart = false;          ///< lone rows are processed apart, all at once
  LoneResponse<Real> lone;          ///< theirs, before others respond
  std::vector<GrippedRow> gripped;  ///< by which one object holds
  std::vector<GrippedRow> braced;   ///< on the other side of what it presses on another one
  Vec3Array<Real> x_unpushed;       ///< positions before the push-out [m]
  Vec3Array<Real> lone_given;       ///< velocity that lone rows gave particles, not noted yet [m/s]
  std::vector<int> changed;         ///< the last sweep between jaws that moved each particle
};

/// Restitution, after all that touches has been stopped. An object gives back a part of what it has
/// taken in this step of the motion along its normal and no more, so that no bounce brings energy,
/// however many rows and layers push each other (Stronge's coefficient of restitution). And only
/// the motion of the last step bounces: what rests has none towards the object, whatever presses on
/// it.
template <class Real>
struct Bounces {
  Vec3Array<Real> v_came, v_kicked;   ///< of this step, as noted; empty if not [m/s]
  std::vector<Impact<Real>> impacts;  ///< of this step
};

/// Solving the rows of a substep.
template <class Real>
struct ObjectSolve {
  const ContactCloths<Real>& cloths;
  ObjectRows<Real>& rows;
  RowResponse<Real>& response;
  Bounces<Real>& bounces;
  ObjectMotion<Real>& motion;  ///< takes the reactions
  RowReach<Real>& reach;       ///< of it lone rows measure the displacements
  ContactLog& log;
  Pinches& pinches;
  Executor* executor;  ///< runs parts of the work on its threads; may be null
  ClothState<Real>& state;
  std::uint64_t friction_evaluations = 0;
};

/// Whether no object moves or has moved since the lists were made.
template <class Real>
bool is_still(const ObjectMotion<Real>& motion, const ObjectRows<Real>& rows) {
  return motion.is_still() && rows.moving.empty();
}

/// Calls visit(r) for each row, without the lone ones if these are processed apart.
template <class Real, class Visit>
void for_joint_rows(const ObjectRows<Real>& rows, const RowResponse<Real>& response,
                    Visit&& visit) {
  if (response.lone_apart) {
    for (const std::size_t r : rows.joint) visit(r);
  } else {
    for (std::size_t r = 0; r < rows.all.size(); ++r) visit(r);
  }
}

/// Lists the rows that can respond in this step: the others are farther from touching than their
/// particles go. Those of objects that move come nearer, and all count.
/// @param travel2  squared displacement of each particle [m^2]
/// @param log      if it wants each impulse, rows respond one by one
template <class Real>
void find_busy_rows(const ObjectRows<Real>& rows, const std::vector<Real>& travel2,
                    const ContactLog& log, RowResponse<Real>& response);

/// Call before rows respond: the impulses that follow are noted, if that is wanted.
template <class Real>
void begin_notes(ObjectSolve<Real>& solve);

/// Call before rows go, or the log is read: what lone rows have given is theirs.
template <class Real>
void note_lone(const ObjectRows<Real>& rows, RowResponse<Real>& response, ContactLog& log);

/// Lets lone rows respond, if they are processed apart.
/// @param pushes  whether they push particles out
template <class Real>
void respond_alone(ObjectSolve<Real>& solve, Real dt, bool pushes);

/// Pushes particles out that lack thickness, slowly and without giving them velocity.
template <class Real>
void push_out(ObjectSolve<Real>& solve, Real smallest_gap, Real dt);

/// Sets the normal velocity that each row must reach: no farther down than the thickness within the
/// step, and none when touching. Notes which points hit.
template <class Real>
void aim_rows(ObjectSolve<Real>& solve, const ObjectShapes<Real>& shapes, Real dt);

/// Shares what each jaw, and each object that presses a layer on another, holds with as friction
/// among the rows that touch it, and those on the other side of the layer.
template <class Real>
void share_hold(ObjectSolve<Real>& solve, const ObjectShapes<Real>& shapes, Real dt);

/// One sweep of projected Gauss-Seidel.
/// @param again  nothing but these rows has changed a velocity since the last sweep: lone ones have
///               what they want
/// @return largest change of a normal velocity [m/s]
template <class Real>
Real sweep_rows(ObjectSolve<Real>& solve, bool again = false);

/// All sweeps of a substep. The rows of cloths with each other are swept after a first sweep over
/// these: what lies on an object in layers would seem to part as long as the object does not carry
/// the lowest one. Cloth that is pressed on an object in layers, or led by hands against it, needs
/// more than the usual sweeps, and those of its own rows in between: without, what the rows leave
/// is stopped by the certificates.
/// @param guard  of the cloths; may be null
template <class Real>
void solve_rows(ObjectSolve<Real>& solve, Real dt, ClothGuard<Real>* guard);

/// Lets what was hit bounce, and then what it meets respond to that, without a bounce.
template <class Real>
void bounce(ObjectSolve<Real>& solve, ClothGuard<Real>* guard);

}  // namespace weft
