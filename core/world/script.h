#pragma once

#include <string>
#include <vector>

#include "core/definition.h"
#include "core/types.h"

namespace weft {

/// Where a hand of a scene pulls to from an instant on, until the next one in a straight line.
struct HandKey {
  double time = 0;               ///< [s], 0 to 3600, growing from one to the next
  Vec3d offset = Vec3d::Zero();  ///< from where it took hold [m], within 1000
};

/// A hand that belongs to the scene: it takes hold at its first key and lets go after the last.
struct HandDef {
  std::string cloth;          ///< name; empty: the first
  double u = 0.5, v = 0.5;    ///< where it holds, each 0 to 1 of the fabric's extent
  double radius = 0.03;       ///< of the held disc in the fabric [m], 0 to 100
  double stiffness = 150;     ///< [N/m], 0 to 1e5
  double max_force = 50;      ///< [N], 0 to 1e6
  std::vector<HandKey> path;  ///< 1 to kMostHandKeys
};

/// Something that is done to a scene at once.
struct InsultDef {
  double time = 0;               ///< [s], 0 to 3600
  double noise = 0;              ///< added to each component of all velocities, at most [m/s]
  Vec3d pinned = Vec3d::Zero();  ///< by which the targets of all pins jump [m], within 100
  double pin_speed = 2;          ///< with which pins then go there [m/s], 0.001 to 20
  double gather = 0;  ///< radius of a ball into which all that is free is put [m], 0 to 10; 0: not
};

/// A wind that blows from an instant on, until the next one.
struct WindKey {
  double time = 0;             ///< [s], 0 to 3600, growing from one to the next
  Vec3d wind = Vec3d::Zero();  ///< mean velocity [m/s], components within 100
};

inline constexpr std::size_t kMostSceneHands = 64, kMostHandKeys = 200, kMostInsults = 100,
                             kMostWinds = 1000;

/// What a hard case must keep to while it runs.
struct VerdictDef {
  double strain = 0;         ///< largest one allowed, 0 to 1000; 0: the scene is no hard case
  double lost_motion = 0.2;  ///< part of the wanted motion that the guard may take, 0 to 1
  double clear_after = 0;    ///< from when on nothing may cross [s], 0 to 3600
  double rest_at = 0;        ///< when it rests as it shall rest again [s], 0 to 3600
  double back_by = 0;        ///< when it must rest so, to 1 % [s], 0 to 3600; 0: never
  /// Most by which the mean height of any cloth may be off then, wherever its particles are [m], 0
  /// to 100; 0: all particles must be where they were.
  double heights = 0;
  double hands_lag = 0;  ///< most that a hand may ever lack of its target [m], 0 to 100; 0: any
};

/// Throws DefinitionError if a field is out of range; `path` stands before the name of the field.
void validate(const HandDef& def, const std::string& path);
void validate(const InsultDef& def, const std::string& path);
void validate(const std::vector<WindKey>& winds);

/// Where the hand pulls to, from where it took hold [m].
Vec3d offset_at(const HandDef& def, double time);

/// A number from -1 to 1 that depends on its arguments alone.
double noise_at(std::uint64_t seed, std::uint64_t particle, std::uint64_t axis);

// Describe each field to `visit(info, value)`.

template <class Def, class Visitor>
void visit_fields_of_hand(Def& hand, Visitor&& visit) {
  visit(FieldInfo{"u", 0, 1, "", "place along u, as a part of the fabric's extent"}, hand.u);
  visit(FieldInfo{"v", 0, 1, "", "place along v, as a part of the fabric's extent"}, hand.v);
  visit(FieldInfo{"radius", 0, 100, "m", "radius of the held disc"}, hand.radius);
  visit(FieldInfo{"stiffness", 0, 1e5, "N/m", "of its spring"}, hand.stiffness);
  visit(FieldInfo{"max_force", 0, 1e6, "N", "beyond which it lags"}, hand.max_force);
}
template <class Def, class Visitor>
void visit_fields_of_hand_key(Def& key, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "when it is there"}, key.time);
  visit(FieldInfo{"offset", -1000, 1000, "m", "from where it took hold"}, key.offset);
}
template <class Def, class Visitor>
void visit_fields_of_insult(Def& insult, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "when it is done"}, insult.time);
  visit(FieldInfo{"noise", 0, 1000, "m/s", "added to all velocities, at most, by component"},
        insult.noise);
  visit(FieldInfo{"pinned", -100, 100, "m", "by which the targets of all pins jump"},
        insult.pinned);
  visit(FieldInfo{"pin_speed", 1e-3, 20, "m/s", "with which pins then go there"}, insult.pin_speed);
  visit(FieldInfo{"gather", 0, 10, "m", "radius of a ball into which all that is free is put"},
        insult.gather);
}
template <class Def, class Visitor>
void visit_fields_of_wind_key(Def& key, Visitor&& visit) {
  visit(FieldInfo{"time", 0, 3600, "s", "from when on"}, key.time);
  visit(FieldInfo{"wind", -100, 100, "m/s", "mean wind velocity"}, key.wind);
}
template <class Def, class Visitor>
void visit_fields_of_verdict(Def& verdict, Visitor&& visit) {
  visit(FieldInfo{"strain", 0, 1000, "", "largest one allowed; 0: no hard case"}, verdict.strain);
  visit(FieldInfo{"lost_motion", 0, 1, "", "part of the wanted motion that may be taken"},
        verdict.lost_motion);
  visit(FieldInfo{"clear_after", 0, 3600, "s", "from when on nothing may cross"},
        verdict.clear_after);
  visit(FieldInfo{"rest_at", 0, 3600, "s", "when it rests as it shall rest again"},
        verdict.rest_at);
  visit(FieldInfo{"back_by", 0, 3600, "s", "when it must rest so again, to 1 %; 0: never"},
        verdict.back_by);
  visit(FieldInfo{"heights", 0, 100, "m",
                  "by which mean heights may be off then; 0: all must be where it was"},
        verdict.heights);
  visit(FieldInfo{"hands_lag", 0, 100, "m", "that a hand may ever lack of its target; 0: any"},
        verdict.hands_lag);
}

}  // namespace weft
