#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/attachments/constants.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/cloth/stability_bound.h"

// Hands that pull the cloth, and slings that throw it.

namespace weft {

/// How a hand acts on the cloth that it holds.
enum class GrabMode : std::uint8_t {
  live,   ///< pulls it to the target all the time
  sling,  ///< leaves it alone until it is fired (the seed's drag)
};

/// A hand that holds the cloth at a point of a triangle. A live one pulls it towards a target with
/// a damped spring of bounded force. A sling, when fired, applies the constant force stiffness
/// (target - held point) for kSlingSeconds, bounded too. Neither sets a position.
struct GrabDef {
  Index triangle = 0;                                               ///< the triangle that was hit
  std::array<double, 3> barycentric = {1.0 / 3, 1.0 / 3, 1.0 / 3};  ///< of the hit, >= 0, sum 1
  double radius = 0.03;    ///< of the held disc in the fabric [m], 0 to 100; 0: only the corners
  double stiffness = 150;  ///< of the spring [N/m], 0 to 1e5
  double max_force = 50;   ///< [N], 0 to 1e6; beyond it the hand lags
  Vec3d target = Vec3d::Zero();  ///< of the hit point [m], components within 1e4
  GrabMode mode = GrabMode::live;
};

using GrabId = std::uint32_t;

template <class Real>
struct Grab {
  GrabId id = 0;
  GrabDef def;
  std::vector<Index> particles;
  std::vector<Real> weights;  ///< of the particles, sum 1
  Vec3<Real> offset;          ///< held point minus weighted mean at the start [m]
  Vec3<Real> target;          ///< of the held point [m]
  Vec3<Real> path_begin,
      path_end;              ///< of the hand in the coming tick, straight; see lead_hands [m]
  Real damping = 0;          ///< of the spring [N s/m]
  StabilityBound bound;      ///< of its spring alone, if that were explicit
  Vec3Array<Real> impulse;   ///< of each particle by the last force, including pinned ones [N s]
  Vec3Array<Real> velocity;  ///< of each particle when last observed [m/s]
  /// Live hand: on the cloth, in the last substep. Sling: if it were fired now [N].
  Vec3<Real> force = Vec3<Real>::Zero();
  /// Live hand under relaxation: velocity of the held point in the last substep if only forces had
  /// acted, and what springs and contact made of it besides [m/s].
  Vec3<Real> unresisted = Vec3<Real>::Zero(), resisted = Vec3<Real>::Zero();
  Vec3d given = Vec3d::Zero();  ///< of a live hand to the cloth, in this tick [N s]
  /// Live hand: mean of its force over the last tick. Sling: as `force` [N].
  Vec3d told = Vec3d::Zero();
};

/// A fired sling while its force still acts.
template <class Real>
struct SlingImpulse {
  std::vector<Index> particles;
  std::vector<Real> weights;  ///< of the particles, sum 1
  Vec3<Real> force;           ///< constant [N]
  int ticks_left = 0;
};

template <class Real>
struct Grabs {
  std::vector<Grab<Real>> list;              ///< in order of creation
  std::vector<SlingImpulse<Real>> impulses;  ///< in order of firing
  GrabId next_id = 1;
};

/// True if no hand pulls and no sling impulse acts.
template <class Real>
bool idle(const Grabs<Real>& grabs) {
  return grabs.list.empty() && grabs.impulses.empty();
}

inline constexpr std::size_t kMostGrabs = 256;  ///< hands and sling impulses together

/// Whether one more hand may take hold.
template <class Real>
bool has_capacity(const Grabs<Real>& grabs) {
  return grabs.list.size() + grabs.impulses.size() < kMostGrabs;
}

/// Takes hold of the held point, from which the hand's path to `def.target` begins. Throws
/// DefinitionError if a field is out of range or there are too many grabs.
template <class Real>
GrabId add_grab(const ClothModel<Real>& model, const ClothState<Real>& state, const GrabDef& def,
                Grabs<Real>& grabs);

/// Damping and bound of a live hand, for the masses that it holds. Call when they have changed.
template <class Real>
void fit_hand(const ClothModel<Real>& model, Grab<Real>& grab);

/// Moves the target; the hand moves there in a straight line over the coming tick, as far as
/// lead_hands allows. Throws DefinitionError if the target is out of range. False if there is no
/// such grab.
template <class Real>
bool move_grab(GrabId id, const Vec3d& target, Grabs<Real>& grabs);

/// Lets go without firing a sling. False if there is no such grab.
template <class Real>
bool remove_grab(GrabId id, Grabs<Real>& grabs);

/// Lets go of a sling and fires it: the cloth gets its force evenly over the coming ticks.
/// @param ticks  their number, at least 1
/// @returns the force [N]; its impulse is the force times the ticks' duration. Nothing, without any
/// change, if there is no such grab or it is a live one.
template <class Real>
std::optional<Vec3<Real>> fire_sling(GrabId id, int ticks, const ClothState<Real>& state,
                                     Grabs<Real>& grabs);

/// Call before each tick: plans each live hand's path from its position towards its target; neither
/// end is farther from the held point than v_max = kFastestHeld lets cloth move in a tick of at
/// least kLeadSeconds. A rule of the scene, independent of the machine's load.
/// @param tick_seconds  [s]
template <class Real>
void lead_hands(double tick_seconds, const Vec3Array<Real>& x, Grabs<Real>& grabs);

/// Call after each tick: hands are at the ends of their paths, sling impulses age.
/// @param tick_seconds  [s]
template <class Real>
void finish_tick(double tick_seconds, Grabs<Real>& grabs);

/// The present position of the held point [m].
template <class Real>
Vec3<Real> held_point(const Grab<Real>& grab, const Vec3Array<Real>& x);

/// Time of a pull within the tick.
template <class Real>
struct HandStep {
  Real progress = 0;  ///< fraction of the tick that has passed, 0 to 1
  Real rate = 0;      ///< ticks per second [1/s]
  Real dt = 0;        ///< time to the next pull [s]
};

/// Call after all other forces have changed the velocities: applies each live hand's force clamp(k
/// (target - p) - c dp/dt), shared by weight, with p and the target at the end of the step that
/// this velocity produces. No velocity exceeds kFastestHeld.
/// @param seconds      duration of the force, as far as the velocities get it
/// @param force_ratio  its true duration over that [1]
template <class Real>
void pull_by_hand(const HandStep<Real>& step, Real seconds, Real force_ratio,
                  ClothState<Real>& state, Grabs<Real>& grabs);

/// The same force for solvers that take forces: adds it to `force`, which contains all others. What
/// constraints will make of the velocity is taken to be what they made of the last one; without
/// this a hand that holds resting cloth would expect a motion that never comes, and pull too
/// little.
/// @param keep     fraction of a velocity left by a step without forces, 0 to 1
/// @param gravity  [m/s^2]
template <class Real>
void add_hand_forces(const HandStep<Real>& step, Real keep, const Vec3<Real>& gravity,
                     const ClothState<Real>& state, Grabs<Real>& grabs, Vec3Array<Real>& force);

/// Call after a substep with `add_hand_forces`, which ended with the velocities `v` [m/s].
template <class Real>
void note_resistance(const Vec3Array<Real>& v, Grabs<Real>& grabs);

/// Adds the constant forces of sling impulses, shared by weight [N].
template <class Real>
void add_sling_forces(const Grabs<Real>& grabs, Vec3Array<Real>& force);

/// The hands have given nothing in the tick that begins.
template <class Real>
void begin_tick(Grabs<Real>& grabs);

/// Call before some substeps of a tick: the held particles have the velocities `v` [m/s].
template <class Real>
void see_velocities(const Vec3Array<Real>& v, Grabs<Real>& grabs);

/// Work of the live hands' last pull while the velocities changed to `v`, by whatever causes: each
/// impulse acts along the mean of the velocities before and after [J].
template <class Real>
double work_of_hands(const Vec3Array<Real>& v, Grabs<Real>& grabs);

}  // namespace weft
