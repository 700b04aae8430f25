#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/cloth/stability_bound.h"

namespace weft {

/// What a hand does with the cloth that it holds.
enum class GrabMode : std::uint8_t {
  live,   ///< pulls it to the target all the time
  sling,  ///< leaves it alone; the force is given when it is fired (the seed's drag)
};

/// For how long a fired sling pushes, rounded to ticks, at least one [s]. One tick alone would give
/// its whole impulse to the few grams of the held disc before the cloth around them can follow.
inline constexpr double kSlingSeconds = 0.1;

/// v_max: no live hand makes the cloth that it holds faster than this [m/s], and none leads it by
/// more than the cloth can follow in a tick at this speed. A target that jumps by metres is
/// approached at v_max, as if the hand pulled less. Otherwise a strong hand would throw the few
/// grams that it holds about at thousands of metres a second, and contact would have to look for
/// what they meet all over the scene. People fling a mouse at some 10 m/s, and robots stay below;
/// the rest lets a hand of the usual stiffness press with the usual 50 N.
inline constexpr double kFastestHeld = 30;

/// Shortest tick for which the lead is counted [s]: hands are no weaker where ticks are shorter.
inline constexpr double kLeadSeconds = 1.0 / 60;

/// A hand that holds the cloth at a point of a triangle. A live one pulls it towards a target with
/// a damped spring of bounded force. A sling gives, when fired, the constant force stiffness
/// (target - held point) for kSlingSeconds, bounded too. Neither sets a position.
struct GrabDef {
  Index triangle = 0;                                               ///< that was hit
  std::array<double, 3> barycentric = {1.0 / 3, 1.0 / 3, 1.0 / 3};  ///< of the hit, >= 0, sum 1
  double radius = 0.03;    ///< of the held disc in the fabric [m], 0 to 100; 0: the corners alone
  double stiffness = 150;  ///< of the spring [N/m], 0 to 1e5
  double max_force = 50;   ///< [N], 0 to 1e6; beyond it the hand lags
  Vec3d target = Vec3d::Zero();  ///< where the hit point shall go [m], components within 1e4
  GrabMode mode = GrabMode::live;
};

using GrabId = std::uint32_t;

template <class Real>
struct Grab {
  GrabId id = 0;
  GrabDef def;
  std::vector<Index> particles;
  std::vector<Real> weights;  ///< of the particles, sum 1
  Vec3<Real> offset;          ///< held point minus weighted mean when taken [m]
  Vec3<Real> target;          ///< where the held point shall go [m]
  Vec3<Real> path_begin,
      path_end;              ///< of the hand in the coming tick, straight; see lead_hands [m]
  Real damping = 0;          ///< of the spring [N s/m]
  StabilityBound bound;      ///< of its spring alone, were it an explicit one
  Vec3Array<Real> impulse;   ///< of each particle by the last force, pinned ones too [N s]
  Vec3Array<Real> velocity;  ///< of each particle when last seen [m/s]
  /// Of a live hand: on the cloth, in the last substep; of a sling: if it were fired now [N].
  Vec3<Real> force = Vec3<Real>::Zero();
};

/// A sling that was fired, while it still pushes.
template <class Real>
struct Shot {
  std::vector<Index> particles;
  std::vector<Real> weights;  ///< of the particles, sum 1
  Vec3<Real> force;           ///< constant [N]
  int ticks_left = 0;
};

template <class Real>
struct Grabs {
  std::vector<Grab<Real>> list;   ///< in the order of their making
  std::vector<Shot<Real>> shots;  ///< in the order of their firing
  GrabId next_id = 1;
};

/// True if nothing pulls or pushes.
template <class Real>
bool idle(const Grabs<Real>& grabs) {
  return grabs.list.empty() && grabs.shots.empty();
}

inline constexpr std::size_t kMostGrabs = 256;  ///< of hands and shots together

/// Whether one more hand may take hold.
template <class Real>
bool has_room(const Grabs<Real>& grabs) {
  return grabs.list.size() + grabs.shots.size() < kMostGrabs;
}

/// Takes hold. The target starts where the point is unless `def.target` says otherwise.
/// Throws DefinitionError if a field is out of range or there are too many grabs.
template <class Real>
GrabId add_grab(const ClothModel<Real>& model, const ClothState<Real>& state, const GrabDef& def,
                Grabs<Real>& grabs);

/// Moves the target; the hand goes there in a straight line over the coming tick, as far as
/// lead_hands lets it.
/// Throws DefinitionError if the target is out of range. False if there is no such grab.
template <class Real>
bool move_grab(GrabId id, const Vec3d& target, Grabs<Real>& grabs);

/// Lets go; a sling is not fired. False if there is no such grab.
template <class Real>
bool remove_grab(GrabId id, Grabs<Real>& grabs);

/// Lets go of a sling and fires it: over the coming ticks the cloth gets its force, evenly.
/// @param ticks  for how many, at least 1
/// @returns the force [N]; its impulse is the force times the ticks' duration. Nothing, and nothing
///     changes, if there is no such grab or it is a live one.
template <class Real>
std::optional<Vec3<Real>> fire_sling(GrabId id, int ticks, const ClothState<Real>& state,
                                     Grabs<Real>& grabs);

/// To be called before each tick: plans each live hand's path from where it was towards its target,
/// neither end farther from the held point than v_max = kFastestHeld lets cloth go in a tick of at
/// least kLeadSeconds. At any load: a rule of the scene, not of the machine.
/// @param tick_seconds  [s]
template <class Real>
void lead_hands(double tick_seconds, const Vec3Array<Real>& x, Grabs<Real>& grabs);

/// To be called after each tick: hands are where their paths ended, shots grow older.
template <class Real>
void finish_tick(Grabs<Real>& grabs);

/// The point that the hand holds, now [m].
template <class Real>
Vec3<Real> held_point(const Grab<Real>& grab, const Vec3Array<Real>& x);

/// Where in a tick hands pull.
template <class Real>
struct HandStep {
  Real progress = 0;  ///< how much of the tick has passed, 0 to 1
  Real rate = 0;      ///< ticks a second [1/s]
  Real dt = 0;        ///< to the next pull [s]
};

/// After all other forces have changed the velocities: so does each live hand, with
/// clamp(k (target - p) - c dp/dt) shared by weight, where p and the target are those at the end of
/// the step that this velocity leads to. No velocity goes beyond kFastestHeld.
/// @param seconds  for which the force acts
template <class Real>
void pull_by_hand(const HandStep<Real>& step, Real seconds, ClothState<Real>& state,
                  Grabs<Real>& grabs);

/// The same force for solvers that take forces: adds it to `force`, where all others are.
/// @param keep     what a step without forces leaves of a velocity, 0 to 1
/// @param gravity  [m/s^2]
template <class Real>
void add_hand_forces(const HandStep<Real>& step, Real keep, const Vec3<Real>& gravity,
                     const ClothState<Real>& state, Grabs<Real>& grabs, Vec3Array<Real>& force);

/// Adds the constant forces of shots, shared by weight [N].
template <class Real>
void add_shot_forces(const Grabs<Real>& grabs, Vec3Array<Real>& force);

/// Adds the forces that hands and shots had last [N].
template <class Real>
void add_last_forces(const Grabs<Real>& grabs, Vec3Array<Real>& force);

/// To be called when a tick begins: the held particles have the velocities `v` [m/s].
template <class Real>
void see_velocities(const Vec3Array<Real>& v, Grabs<Real>& grabs);

/// Work of the live hands' last pull while the velocities became `v`, whoever else had a part in
/// that: each impulse acts along with the mean of those before and after [J].
template <class Real>
double work_of_hands(const Vec3Array<Real>& v, Grabs<Real>& grabs);

}  // namespace weft
