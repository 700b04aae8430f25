#pragma once

// Ranges of what a command of the wire may change. Core checks its definitions against them, and
// proto its messages, which include this header of numbers alone; so each is stated once.

namespace weft {

/// Allowed values of a number, or of each component of a vector. Both ends are allowed.
struct Range {
  double minimum = 0;
  double maximum = 0;
};

// Places.
inline constexpr Range kPositionRange{-1e4, 1e4};  ///< of pins, hands, fans and rays [m]
inline constexpr Range kPivotRange{-1000, 1000};   ///< of a collider or gripper [m]

// Hands.
inline constexpr Range kRadiusRange{0, 100};     ///< of a disc in the fabric [m]
inline constexpr Range kStiffnessRange{0, 1e5};  ///< of a hand [N/m]
inline constexpr Range kForceRange{0, 1e6};      ///< of a hand or a moving pin [N]

// Objects and pins that move.
inline constexpr Range kMoveSpeedRange{1e-3, 20};    ///< of a collider, gripper or pin [m/s]
inline constexpr Range kTurnSpeedRange{1e-3, 60};    ///< of a collider or gripper [rad/s]
inline constexpr Range kOpeningRange{0, 1};          ///< between a gripper's jaws [m]
inline constexpr Range kGripRange{0, 1000};          ///< force of each jaw [N]
inline constexpr Range kFrictionFactorRange{0, 10};  ///< of an object, times that of cloth

// Gravity and air.
inline constexpr Range kGravityRange{-1000, 1000};   ///< each component [m/s^2]
inline constexpr Range kWindRange{-100, 100};        ///< each component [m/s]
inline constexpr Range kGustSpeedRange{0, 100};      ///< [m/s]
inline constexpr Range kGustLengthRange{0.01, 100};  ///< [m]
inline constexpr Range kAirDensityRange{0, 1000};    ///< [kg/m^3]
inline constexpr Range kDragRange{0, 1000};          ///< uniform damping [1/s]
inline constexpr unsigned kMostFans = 4;
inline constexpr Range kFanSpeedRange{0, 50};      ///< [m/s]
inline constexpr Range kFanRadiusRange{0.01, 10};  ///< [m]
inline constexpr Range kFanSpreadRange{0, 2};      ///< a slope
inline constexpr Range kFanReachRange{0.01, 100};  ///< [m]

// Fabric.
inline constexpr Range kArealDensityRange{1e-3, 100};  ///< [kg/m^2]
inline constexpr Range kStretchRange{0, 1e6};          ///< stretch and shear stiffness [N/m]
inline constexpr Range kBendingRange{0, 10};           ///< rigidity [N m]
inline constexpr Range kPoissonRange{-1, 100};         ///< of a mesh; -1: as on a grid
inline constexpr Range kLockingStrainRange{0, 10};     ///< from which a thread is stiffer; 0: none
inline constexpr Range kLockingFactorRange{1, 1000};   ///< how many times as stiff it then is
inline constexpr Range kDampingRatioRange{0, 1};       ///< of the membrane's highest mode
inline constexpr Range kRelaxationTimeRange{0, 10};    ///< of stretch, shear or bending [s]
inline constexpr Range kThicknessRange{1e-4, 0.1};     ///< contact distance from objects [m]
inline constexpr Range kFrictionRange{0, 10};          ///< Coulomb coefficient
inline constexpr Range kRestitutionRange{0, 0.999};    ///< of the impact velocity
inline constexpr Range kAirNormalRange{0, 100};        ///< drag coefficient across the wind
inline constexpr Range kAirTangentialRange{0, 100};    ///< skin friction [kg/(m^2 s)]
inline constexpr Range kSoftnessRange{0.01, 1};        ///< fraction of the springs' stiffness

// Time.
inline constexpr Range kBudgetRange{0, 1000};  ///< for each due tick [ms]

}  // namespace weft
