#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/attachments/pin_place.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"

// Pins that fix particles, or carry them to a target.

namespace weft {

/// Identifies a pin; never reused.
using PinId = std::uint32_t;

inline constexpr double kLeastPinSpeed = kMoveSpeedRange.minimum;
inline constexpr double kMostPinSpeed = kMoveSpeedRange.maximum;  ///< [m/s]

/// Limit of a pin's target along each axis [m].
inline constexpr double kFarthestPinTarget = kPositionRange.maximum;

/// Target of a pin. The pin moves in a straight line and lags when blocked: its particles follow as
/// fast as the bound of its force and obstacles permit.
struct PinMove {
  /// Of its middle particle [m], components within kFarthestPinTarget.
  Vec3d target = Vec3d::Zero();
  double speed = 2;       ///< limit [m/s], 0.001 to 20
  double max_force = 50;  ///< of the pin on the cloth during the motion [N], 0 to 1e6
};

/// Motion of a pin until it has arrived. See pin_drive.h.
struct PinPath {
  PinMove move;
  std::vector<Vec3d> start;       ///< positions of its particles at the first command [m]
  Vec3d offset = Vec3d::Zero();   ///< from there to their present places [m]
  Vec3d step = Vec3d::Zero();     ///< increment in the coming tick [m]
  double pace = 0;                ///< in the last tick [m/s]
  bool behind = false;            ///< its particles lagged at the start of the last tick
  std::vector<Vec3d> velocity;    ///< last given to its particles [m/s]
  Vec3d impulse = Vec3d::Zero();  ///< given to the cloth in this tick [N s]
};

struct Pin {
  PinId id = 0;
  PinDef def;
  Index centre = 0;                ///< a particle in the middle of the held ones
  std::vector<Index> particles;    ///< ascending
  std::optional<PinPath> path;     ///< while it moves; otherwise its particles are fixed
  Vec3d drive = Vec3d::Zero();     ///< mean force on the cloth in its last moving tick [N]
  std::optional<ClampLine> clamp;  ///< of a strip, also while it moves
  std::optional<ClampDisc> disc;   ///< that clamps, likewise
};

/// All pins of a cloth. Overlapping pins are counted: a particle is free when its last pin is
/// removed.
struct Pins {
  std::vector<Pin> list;         ///< in order of creation
  std::vector<int> pin_count;    ///< for each particle
  std::vector<int> fixed_count;  ///< of those that rest
  std::size_t held = 0;          ///< particles of all pins together, each counted for each pin
  PinId next_id = 1;

  /// Whether any pin is moving.
  bool any_moving() const;
};

/// The clamps of all pins, which refer to these.
Clamps clamps_of(const Pins& pins);

/// Whether a resting pin holds a particle.
bool is_fixed(const Pins& pins, Index particle);

inline constexpr std::size_t kMostPins = 4096;
/// Most particles of all pins of a world together. What pins cost, and the memory of them in each
/// copy of a world, goes with these.
inline constexpr std::size_t kMostHeld = 1'000'000;

/// Sizes the counters for a cloth without pins.
template <class Real>
Pins make_pins(const ClothModel<Real>& model);

/// Pins particles at their present positions with zero velocity.
/// Throws DefinitionError if the place does not exist, or there are too many pins or they hold too
/// many particles.
template <class Real>
PinId add_pin(const ClothModel<Real>& model, const PinDef& def, Pins& pins,
              ClothState<Real>& state);

/// Sends a pin to a target. Until it arrives, its particles are driven instead of fixed. Throws
/// DefinitionError, without any change, if a field is out of range. False if there is no such pin.
template <class Real>
bool move_pin(const ClothModel<Real>& model, PinId id, const PinMove& move, Pins& pins,
              ClothState<Real>& state);

/// Ends the motion of a pin: its particles are fixed where they are. False if there is no such pin.
template <class Real>
bool stop_pin(PinId id, Pins& pins, ClothState<Real>& state);

/// Throws DefinitionError if a field of a move is out of range.
void validate(const PinMove& move);

/// Removes a pin and frees its particles, unless other pins hold them. False if there is no such
/// pin.
template <class Real>
bool remove_pin(const ClothModel<Real>& model, PinId id, Pins& pins, ClothState<Real>& state);

/// Passes each field of a move to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_pin_move(Def& move, Visitor&& visit) {
  visit(FieldInfo{"position", kPositionRange, "m", "target of the pin's middle"}, move.target);
  visit(FieldInfo{"speed", kMoveSpeedRange, "m/s", "of the pin, at most"}, move.speed);
  visit(FieldInfo{"max_force", kForceRange, "N", "of the pin on its way; beyond it the pin lags"},
        move.max_force);
}

}  // namespace weft
