#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/attachments/pin_place.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

namespace weft {

/// Names a pin for its whole life; never used again for another.
using PinId = std::uint32_t;

inline constexpr double kLeastPinSpeed = 1e-3, kMostPinSpeed = 20;  ///< [m/s]

/// Farthest that a pin may be sent along an axis [m].
inline constexpr double kFarthestPinTarget = 1e4;

/// Where a pin is to go. It goes there in a straight line and is a target that lags when blocked:
/// its particles follow as fast as the bound of its force and what is in their way let them.
struct PinMove {
  Vec3d target =
      Vec3d::Zero();      ///< of its middle particle [m], components within kFarthestPinTarget
  double speed = 2;       ///< at most [m/s], 0.001 to 20
  double max_force = 50;  ///< of the pin on the cloth while it is on its way [N], 0 to 1e6
};

/// The way of a pin until it has arrived. See pin_drive.h.
struct PinPath {
  PinMove move;
  std::vector<Vec3d> start;       ///< of its particles when it was first told to go [m]
  Vec3d offset = Vec3d::Zero();   ///< from there to where they shall be now [m]
  Vec3d step = Vec3d::Zero();     ///< by which it grows in the coming tick [m]
  double pace = 0;                ///< in the last tick [m/s]
  bool behind = false;            ///< its particles did not follow when the last tick began
  std::vector<Vec3d> velocity;    ///< that it gave its particles last [m/s]
  Vec3d impulse = Vec3d::Zero();  ///< given to the cloth in this tick [N s]
};

struct Pin {
  PinId id = 0;
  PinDef def;
  Index centre = 0;              ///< a particle in the middle of those held
  std::vector<Index> particles;  ///< ascending
  std::optional<PinPath> path;   ///< while it is on its way; else its particles are fixed
  Vec3d drive = Vec3d::Zero();   ///< mean force on the cloth in the last tick on its way [N]
};

/// All pins of a cloth. Overlapping pins count: a particle is free when the last of its pins goes.
struct Pins {
  std::vector<Pin> list;       ///< in the order of their making
  std::vector<int> pin_count;  ///< for each particle
  PinId next_id = 1;

  /// Whether one of them is on its way.
  bool any_on_way() const;
};

/// Whether a pin that stays where it is holds a particle.
bool is_fixed(const Pins& pins, Index particle);

inline constexpr std::size_t kMostPins = 4096;

/// Sizes the counters for a cloth without pins.
template <class Real>
Pins make_pins(const ClothModel<Real>& model);

/// Pins particles at their present positions with velocity zero.
/// Throws DefinitionError if the place does not exist or there are too many pins.
template <class Real>
PinId add_pin(const ClothModel<Real>& model, const PinDef& def, Pins& pins,
              ClothState<Real>& state);

/// Tells a pin to go somewhere. Its particles are then no longer fixed, but driven, until they are
/// there. Throws DefinitionError if a field is out of range; nothing changes then. False if there
/// is no such pin.
template <class Real>
bool move_pin(const ClothModel<Real>& model, PinId id, const PinMove& move, Pins& pins,
              ClothState<Real>& state);

/// Ends the way of a pin: its particles are fixed where they are. False if there is no such pin.
template <class Real>
bool stop_pin(PinId id, Pins& pins, ClothState<Real>& state);

/// Throws DefinitionError if a field of a move is out of range.
void validate(const PinMove& move);

/// Frees the particles of a pin that no other pin holds. False if there is no such pin.
template <class Real>
bool remove_pin(const ClothModel<Real>& model, PinId id, Pins& pins, ClothState<Real>& state);

/// Describes each field of a move to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_pin_move(Def& move, Visitor&& visit) {
  visit(FieldInfo{"position", -kFarthestPinTarget, kFarthestPinTarget, "m",
                  "where the middle of the pin goes"},
        move.target);
  visit(FieldInfo{"speed", kLeastPinSpeed, kMostPinSpeed, "m/s", "of the pin, at most"},
        move.speed);
  visit(FieldInfo{"max_force", 0, 1e6, "N", "of the pin on its way; beyond it the pin lags"},
        move.max_force);
}

}  // namespace weft
