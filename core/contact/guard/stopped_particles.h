#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/guard/guarded_pairs.h"
#include "core/types.h"

// Particles that a certificate stops short of where they wanted to go.

namespace weft {

/// Two features whose particles were stopped at planes between them.
template <class Real>
struct StoppedPair {
  std::array<Index, 4> particle = {0, 0, 0, 0};
  std::array<Real, 4> weight = {0, 0, 0, 0};  ///< of the closest points, as PairSeparation has it
  Vec3<Real> normal = Vec3<Real>::Zero();     ///< from the second side to the first
  std::uint64_t key = 0;
  Real pushed = 0;  ///< impulse that its sides then got from each other along the normal [N s]
};

/// A pair that was stopped in so many steps that its particles are jammed.
struct JammedPair {
  std::uint64_t key = 0;
  Index first = 0;  ///< its first particle
};

/// A particle that goes less far in the coming drift than its velocity says.
template <class Real>
struct StoppedParticle {
  Index particle = 0;
  Vec3<Real> v = Vec3<Real>::Zero();        ///< its velocity [m/s]
  Vec3<Real> v_drift = Vec3<Real>::Zero();  ///< and that of the drift [m/s]
};

/// How many steps in a row a particle was stopped.
struct StopsInARow {
  std::uint64_t step = 0;  ///< the last of them
  int count = 0;
};

/// What is stopped is stopped for one drift. To take its velocity for good would take momentum that
/// no other particle gets, also along the contact and from what both sides have in common; so each
/// particle gets its velocity back after the drift, and then the pairs at whose planes it stopped
/// take their approach from each other. Only what is jammed, and stopped in kMostInARow steps
/// before, loses it: it would press on for ever, and its pair gets a row. Where nothing but cloth
/// is near, all particles alike get what the centre of mass has lost by that.
template <class Real>
struct StoppedParticles {
  std::vector<StoppedParticle<Real>> list;
  std::vector<Index> place_of;        ///< of each particle in the list, or kNone
  std::vector<StopsInARow> in_a_row;  ///< of each particle
  std::uint64_t step = 2;             ///< the one that ended last
  std::vector<StoppedPair<Real>> pairs;
  std::vector<JammedPair> jammed;  ///< in the last step
  bool any = false;                ///< something was stopped in the last step
};

/// @param particles  number of all
template <class Real>
StoppedParticles<Real> stopped_particles(std::size_t particles);

/// Notes that a particle is stopped, perhaps once more.
/// @param v        its velocity when it was stopped first [m/s]
/// @param v_drift  in the coming drift [m/s]
template <class Real>
void note_stopped(Index particle, const Vec3<Real>& v, const Vec3<Real>& v_drift,
                  StoppedParticles<Real>& stopped);

/// Gives the particles their velocities back after the drift, unless they are jammed. One whose
/// velocity is no longer that of the drift keeps it: something else has stopped it too.
template <class Real>
void give_velocities_back(StoppedParticles<Real>& stopped, Vec3Array<Real>& v);

/// Gives all particles alike what their centre of mass lacks of a velocity.
/// @param state  in which all particles are free
template <class Real>
void keep_mean_velocity(const Vec3d& mean, ClothState<Real>& state);

/// Lets the stopped pairs take the velocity of their approach from each other, without a bounce:
/// impulses along their normals, which keep momentum and take energy.
template <class Real>
void meet_at_planes(const std::vector<Real>& inverse_mass, StoppedParticles<Real>& stopped,
                    Vec3Array<Real>& v);

/// Notes that no particle moves in the coming drift.
/// @param v  their velocities [m/s]
template <class Real>
void note_all_stopped(const Vec3Array<Real>& v, StoppedParticles<Real>& stopped);

/// Forgets all that was stopped; keeps the memory.
template <class Real>
void forget_stopped(StoppedParticles<Real>& stopped);

}  // namespace weft
