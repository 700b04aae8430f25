#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/field.h"
#include "proto/limits.h"
#include "proto/messages/right.h"
#include "proto/types.h"

// The command `set`: forces and settings of a room.

namespace weft::proto {

/// A local wind; README.md section 5 defines its numbers.
struct Fan {
  Vec3 position{}, direction{};
  double speed = 5;
  double radius = 0.25;
  double spread = 0.2;
  double reach = 1.5;
  bool operator==(const Fan&) const = default;

  static constexpr const char* kName = "Fan";
  static void describe(auto& io, auto& fan) {
    io.required(Field{"position", "centre of the disc that its air leaves", kPositionRange, "m"},
                fan.position);
    io.required(
        Field{"direction", "of the jet, any length but 0", kPositionRange, "", Form::direction},
        fan.direction);
    io.optional(Field{"speed", "in the core of the jet", kFanSpeedRange, "m/s"}, fan.speed);
    io.optional(Field{"radius", "of the disc", kFanRadiusRange, "m"}, fan.radius);
    io.optional(Field{"spread", "growth of the jet's radius per distance", kFanSpreadRange},
                fan.spread);
    io.optional(Field{"reach", "length of the core", kFanReachRange, "m"}, fan.reach);
  }
};

/// The room's remedy if ticks exceed their time budget.
enum class OverBudget : std::uint8_t { slow, soften };
template <>
inline constexpr std::array<const char*, 2> kWords<OverBudget> = {"slow", "soften"};

/// What a cloth is made of; omitted values stay as they are, or as in the preset.
struct FabricChange {
  std::optional<std::string> preset;
  std::optional<double> areal_density, stretch_warp, stretch_weft, shear, poisson, bending_warp,
      bending_weft, locking_strain, locking_factor, damping_ratio, stretch_damping, shear_damping,
      bending_damping, thickness, friction, restitution, air_normal, air_tangential;
  bool operator==(const FabricChange&) const = default;

  static constexpr const char* kName = "Fabric";
  static void describe(auto& io, auto& fabric) {
    io.optional(
        Field{"preset", "all values of this one", {1, kMostSceneBytes}, "bytes", Form::bytes},
        fabric.preset);
    io.optional(Field{"areal_density", "mass per area", kArealDensityRange, "kg/m²"},
                fabric.areal_density);
    io.optional(Field{"stretch_warp", "stiffness along u", kStretchRange, "N/m"},
                fabric.stretch_warp);
    io.optional(Field{"stretch_weft", "stiffness along v", kStretchRange, "N/m"},
                fabric.stretch_weft);
    io.optional(Field{"shear", "stiffness", kStretchRange, "N/m"}, fabric.shear);
    io.optional(
        Field{"poisson", "of a mesh: narrowing along v per strain along u; -1: as on a grid",
              kPoissonRange},
        fabric.poisson);
    io.optional(Field{"bending_warp", "rigidity along u", kBendingRange, "N m"},
                fabric.bending_warp);
    io.optional(Field{"bending_weft", "rigidity along v", kBendingRange, "N m"},
                fabric.bending_weft);
    io.optional(
        Field{"locking_strain", "from which a thread is stiffer; 0: none", kLockingStrainRange},
        fabric.locking_strain);
    io.optional(Field{"locking_factor", "how many times as stiff it then is", kLockingFactorRange},
                fabric.locking_factor);
    io.optional(Field{"damping_ratio", "of the highest mode of stretch", kDampingRatioRange},
                fabric.damping_ratio);
    io.optional(Field{"stretch_damping", "relaxation time", kRelaxationTimeRange, "s"},
                fabric.stretch_damping);
    io.optional(Field{"shear_damping", "relaxation time", kRelaxationTimeRange, "s"},
                fabric.shear_damping);
    io.optional(Field{"bending_damping", "relaxation time", kRelaxationTimeRange, "s"},
                fabric.bending_damping);
    io.optional(Field{"thickness", "distance from objects in contact", kThicknessRange, "m"},
                fabric.thickness);
    io.optional(Field{"friction", "Coulomb's coefficient", kFrictionRange}, fabric.friction);
    io.optional(Field{"restitution", "of the impact velocity", kRestitutionRange},
                fabric.restitution);
    io.optional(Field{"air_normal", "drag coefficient across the wind", kAirNormalRange},
                fabric.air_normal);
    io.optional(
        Field{"air_tangential", "skin friction along the wind", kAirTangentialRange, "kg/(m² s)"},
        fabric.air_tangential);
    io.one_at_least("fabric has nothing to set");
  }
};

/// All are applied or, if one is refused, none.
struct Set {
  std::optional<Vec3> gravity, wind;
  std::optional<double> gust_speed, gust_length, air_density;
  std::optional<bool> still_air;
  std::optional<double> drag;
  std::optional<std::vector<Fan>> fans;
  std::optional<double> softness, budget_ms;
  std::optional<OverBudget> over_budget;
  std::optional<FabricChange> fabric;
  std::optional<ColliderRef> cloth;  ///< absent: the first
  bool operator==(const Set&) const = default;

  static constexpr const char* kOp = "set";
  static constexpr Right kRight = Right::operate;
  static void describe(auto& io, auto& set) {
    io.optional(Field{"gravity", "acceleration", kGravityRange, "m/s²"}, set.gravity);
    io.optional(Field{"wind", "mean velocity", kWindRange, "m/s"}, set.wind);
    io.optional(Field{"gust_speed", "bound of each component of the gusts", kGustSpeedRange, "m/s"},
                set.gust_speed);
    io.optional(Field{"gust_length", "size of an eddy", kGustLengthRange, "m"}, set.gust_length);
    io.optional(Field{"air_density", "of the air", kAirDensityRange, "kg/m³"}, set.air_density);
    io.optional(Field{"still_air", "air resists without wind too"}, set.still_air);
    io.optional(Field{"drag", "uniform damping of velocities", kDragRange, "1/s"}, set.drag);
    io.optional(Field{"fans", "all local winds", {0, kMostFans}}, set.fans);
    io.optional(Field{"softness", "fraction of the springs' stiffness", kSoftnessRange},
                set.softness);
    io.optional(Field{"budget_ms", "for each tick that is due; 0: no bound", kBudgetRange, "ms"},
                set.budget_ms);
    io.optional(Field{"over_budget", "what gives way beyond it"}, set.over_budget);
    io.optional(Field{"fabric", "of one cloth"}, set.fabric);
    io.one_at_least("set has nothing to set");
    io.only_if(set.fabric.has_value(), "fabric",
               Field{"cloth",
                     "whose fabric: its name, or its place in the list of `mesh`; the "
                     "first by default"},
               set.cloth, false);
  }
};

}  // namespace weft::proto
