#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types.h"

// What Contact works on: pairs that may meet, and contacts of cloth with objects.

namespace weft {

/// Settings of the contact of a cloth with objects; each of several cloths has its own.
struct ContactDef {
  double thickness = 0.004;  ///< distance that the mid-surface keeps from objects [m]
  double friction = 0.4;     ///< Coulomb coefficient
  double restitution = 0;  ///< k_diss of the seed's eq. (10): part of the normal velocity returned
  Index first_particle = 0;  ///< of the cloth
};

/// A pair that may come into contact before candidates are collected again.
template <class Real>
struct ContactCandidate {
  Index cloth = 0;    ///< particle, edge or triangle of the cloth
  Index feature = 0;  ///< triangle, edge or vertex of the mesh
  Real distance = 0;  ///< when collected [m]
};

/// One contact of up to three particles with a plane, which goes with its object (MovingRow): gap =
/// sum w n.x - offset. The plane separates the cloth's feature from the (convex) feature of the
/// object, so a particle that stays on its side has not crossed.
template <class Real>
struct ContactRow {
  std::array<Index, 3> particle = {0, 0, 0};
  std::array<Real, 3> weight = {0, 0, 0};
  std::array<Real, 3> share = {0, 0, 0};   ///< of each in a change of the row's velocity, by mass
  std::uint32_t count = 0;                 ///< of particles
  Vec3<Real> normal = Vec3<Real>::Zero();  ///< out of the object
  Real offset = 0;                         ///< [m]
  Real distance = 0;                       ///< when the row was built [m]
  Real least_height = 0;                   ///< of a particle over the plane, then [m]
  Real keep = 0;                           ///< height over the plane that its particles keep [m]
  Real least_speed = 0;                    ///< that the normal velocity must reach now [m/s]
  Real thickness = 0;                      ///< that the cloth keeps [m]
  Real friction = 0;                       ///< Coulomb coefficient
  Index cloth = 0;                         ///< whose thickness and restitution it has
  Index mover = kNone;                     ///< number among the rows with moving objects
  Index collider = 0;                      ///< the object
  Index impact = kNone;                    ///< number among the impacts of this step
  bool responds = true;                    ///< false: only certifies, another pair responds
};

/// sum w values: a position or velocity of the row's point of the cloth. Most rows have one
/// particle, of weight 1.
template <class Real>
[[gnu::always_inline]] inline Vec3<Real> weighted(const ContactRow<Real>& row,
                                                  const Vec3Array<Real>& values) {
  const auto at = [&](std::size_t k) -> const Vec3<Real>& {
    return values[at_index(row.particle[k])];
  };
  assert(row.count >= 1 && row.count <= 3);
  if (row.count == 1) return at(0);
  const Vec3<Real> two = at(0) * row.weight[0] + at(1) * row.weight[1];
  return row.count == 2 ? two : (two + at(2) * row.weight[2]).eval();
}

/// Moves the row's point by `change`, shared by mass.
template <class Real>
void share_out(const ContactRow<Real>& row, const Vec3<Real>& change, Vec3Array<Real>& values) {
  for (std::size_t k = 0; k < row.count; ++k)
    values[at_index(row.particle[k])] += change * row.share[k];
}

/// How far the particles of a row may move before the row matters.
template <class Real>
struct RowRoom {
  std::array<Index, 3> particle;
  Real touch2;  ///< squared, until it responds [m^2]
  Real cross2;  ///< squared, until one could cross its plane [m^2]
};

/// Squared way of the particle of a row that goes farthest [m^2].
/// @param travel2  of each particle
template <class Real>
Real farthest2(const RowRoom<Real>& room, const std::vector<Real>& travel2) {
  return std::max({travel2[at_index(room.particle[0])], travel2[at_index(room.particle[1])],
                   travel2[at_index(room.particle[2])]});
}

/// What a row with an object that moves has besides.
template <class Real>
struct MovingRow {
  std::size_t row = 0;
  std::size_t collider = 0;
  Vec3d own_normal = Vec3d::Zero();  ///< of the plane, in the object's own frame
  double own_offset = 0;             ///< [m]
  Real mobility = 0;                 ///< velocity that an impulse gives the row's point [1/kg]
  Vec3<Real> surface = Vec3<Real>::Zero();  ///< velocity of the object there [m/s]
  bool counted = false;   ///< its pushes are part of the force that its grip is shared from
  Index presser = kNone;  ///< the object that presses a layer by it
  std::size_t side = 0;   ///< of that layer: 0 next to that object, 1 behind it
  Real grip = 0;  ///< friction that the jaw, and what pushes besides, allow in this step [m/s]
  Vec3<Real> rubbed = Vec3<Real>::Zero();  ///< the part of it that acts [m/s]
  Vec3d given = Vec3d::Zero();  ///< to the row's point in this step, and not booked yet [m/s]
};

/// What a row has besides whose point hits its object in this step and shall bounce.
template <class Real>
struct Impact {
  std::size_t row = 0;
  Real speed = 0;  ///< to leave with [m/s]
  /// What the object has taken of the point's motion along the normal until now: twice the energy
  /// over the point's mass [m^2/s^2].
  Real taken = 0;
};

/// A cloth that got into an object other than through contact: it started there. Until it is out
/// nothing is promised about the two; it is led out in one direction, with its folds.
template <class Real>
struct BadStart {
  std::size_t collider = 0;
  Index cloth = 0;
  Vec3<Real> direction = Vec3<Real>::UnitY();  ///< in which it leaves, in the object's frame, unit
  std::size_t particles = 0;                   ///< how many are still inside
};

}  // namespace weft
