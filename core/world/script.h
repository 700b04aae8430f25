#pragma once

#include <string>
#include <vector>

#include "core/definition.h"
#include "core/types.h"

// Scheduled events of a scene, and the limits of hard cases.

namespace weft {

/// Target of a scene's hand at an instant; it moves in a straight line to the next one.
struct HandKey {
  double time = 0;               ///< [s], 0 to 3600, increasing from key to key
  Vec3d offset = Vec3d::Zero();  ///< from the held point at the start [m], within 1000
};

/// A hand of the scene itself: it takes hold at its first key and lets go after the last.
struct HandDef {
  std::string cloth;          ///< name; empty: the first
  double u = 0.5, v = 0.5;    ///< held point, each 0 to 1 of the fabric's extent
  double radius = 0.03;       ///< of the held disc in the fabric [m], 0 to 100
  double stiffness = 150;     ///< [N/m], 0 to 1e5
  double max_force = 50;      ///< [N], 0 to 1e6
  std::vector<HandKey> path;  ///< 1 to kMostHandKeys
};

/// A sudden disturbance of a scene.
struct DisturbanceDef {
  double time = 0;               ///< [s], 0 to 3600
  double noise = 0;              ///< most that is added to each component of velocities [m/s]
  Vec3d pinned = Vec3d::Zero();  ///< jump of all pins' targets [m], within 100
  double pin_speed = 2;          ///< of the pins towards them [m/s], 0.001 to 20
  double gather = 0;  ///< radius of a ball that all free particles are put into [m], 0 to 10; 0: no
};

/// A wind that blows from an instant on, until the next one.
struct WindKey {
  double time = 0;             ///< [s], 0 to 3600, increasing from key to key
  Vec3d wind = Vec3d::Zero();  ///< mean velocity [m/s], components within 100
};

inline constexpr std::size_t kMostSceneHands = 64, kMostHandKeys = 200, kMostDisturbances = 100,
                             kMostWinds = 1000;

/// Limits that a hard case must keep.
struct VerdictDef {
  double strain = 0;         ///< largest allowed, 0 to 1000; 0: the scene is not a hard case
  double lost_motion = 0.2;  ///< fraction of the wanted motion that the guard may take, 0 to 1
  double clear_after = 0;    ///< time after which nothing may cross [s], 0 to 3600
  double rest_at = 0;        ///< when it has the rest shape to return to [s], 0 to 3600
  double back_by = 0;        ///< when it must have returned, to 1 % [s], 0 to 3600; 0: never
  /// Largest error of any cloth's mean height then, wherever its particles are [m], 0 to 100; 0:
  /// all particles must be where they were.
  double heights = 0;
  double hands_lag = 0;  ///< largest distance of a hand from its target [m], 0 to 100; 0: any
};

/// Throws DefinitionError if a field is out of range; `path` precedes the field's name.
void validate(const HandDef& def, const std::string& path);
void validate(const DisturbanceDef& def, const std::string& path);
void validate(const std::vector<WindKey>& winds);

/// Displacement of the hand's target from the held point at the start [m].
Vec3d offset_at(const HandDef& def, double time);

/// A number from -1 to 1 that depends only on its arguments.
double noise_at(std::uint64_t seed, std::uint64_t particle, std::uint64_t axis);

// Pass each field to `visit(info, value)`.

template <class Def, class Visitor>
void visit_fields_of_hand(Def& hand, Visitor&& visit) {
  visit(FieldInfo{"u", 0, 1, "", "place along u, as a fraction of the fabric's extent"}, hand.u);
  visit(FieldInfo{"v", 0, 1, "", "place along v, as a fraction of the fabric's extent"}, hand.v);
  visit(FieldInfo{"radius", kRadiusRange, "m", "radius of the held disc"}, hand.radius);
  visit(FieldInfo{"stiffness", kStiffnessRange, "N/m", "stiffness of its spring"}, hand.stiffness);
  visit(FieldInfo{"max_force", kForceRange, "N", "force beyond which it lags"}, hand.max_force);
}
template <class Def, class Visitor>
void visit_fields_of_hand_key(Def& key, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "when it is reached"}, key.time);
  visit(FieldInfo{"offset", -1000, 1000, "m", "offset from the held point at the start"},
        key.offset);
}
template <class Def, class Visitor>
void visit_fields_of_disturbance(Def& disturbance, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "when it happens"}, disturbance.time);
  visit(
      FieldInfo{"noise", 0, 1000, "m/s", "most that is added to each component of all velocities"},
      disturbance.noise);
  visit(FieldInfo{"pinned", -100, 100, "m", "jump of all pins' targets"}, disturbance.pinned);
  visit(FieldInfo{"pin_speed", kMoveSpeedRange, "m/s", "speed of the pins towards them"},
        disturbance.pin_speed);
  visit(FieldInfo{"gather", 0, 10, "m", "radius of a ball that all free particles are put into"},
        disturbance.gather);
}
template <class Def, class Visitor>
void visit_fields_of_wind_key(Def& key, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "start time"}, key.time);
  visit(FieldInfo{"wind", kWindRange, "m/s", "mean wind velocity"}, key.wind);
}
template <class Def, class Visitor>
void visit_fields_of_verdict(Def& verdict, Visitor&& visit) {
  visit(FieldInfo{"strain", 0, 1000, "", "largest allowed; 0: not a hard case"}, verdict.strain);
  visit(FieldInfo{"lost_motion", 0, 1, "", "fraction of the wanted motion that the guard may take"},
        verdict.lost_motion);
  visit(FieldInfo{"clear_after", 0, 3600, "s", "time after which nothing may cross"},
        verdict.clear_after);
  visit(FieldInfo{"rest_at", 0, 3600, "s", "when it has the rest shape to return to"},
        verdict.rest_at);
  visit(FieldInfo{"back_by", 0, 3600, "s", "when it must have returned to it, to 1 %; 0: never"},
        verdict.back_by);
  visit(FieldInfo{"heights", 0, 100, "m",
                  "largest error of mean heights then; 0: all particles must be back"},
        verdict.heights);
  visit(FieldInfo{"hands_lag", 0, 100, "m", "largest distance of a hand from its target; 0: any"},
        verdict.hands_lag);
}

}  // namespace weft
