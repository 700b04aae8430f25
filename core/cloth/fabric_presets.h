#pragma once

#include <string>
#include <vector>

#include "core/cloth/fabric.h"

namespace weft {

/// Drape coefficients that are published for a kind of fabric [%].
struct DrapeBand {
  double low = 0, high = 0;  ///< both 0: none is known
};

/// A fabric by name.
struct FabricPreset {
  const char* name;
  const char* description;
  FabricDef fabric;
  DrapeBand drape;  ///< of a disc of 30 cm on one of 18 cm (BS 5058)
};

/// cotton, silk, wool, denim, leather, nylon. Sources of the values stand beside them.
const std::vector<FabricPreset>& fabric_presets();

/// Throws DefinitionError on field "fabric" if there is none of this name.
FabricDef make_fabric(const std::string& name);

inline constexpr double kLongestBendingLength = 0.2;  ///< that is accepted [m]

/// Bending rigidity of a fabric with this bending length, B = sigma g c^3 [N m] (ASTM D1388).
/// @param areal_density   sigma [kg/m^2]
/// @param bending_length  c [m]: half the overhang at which a strip hangs 41.5 degrees down
double bending_rigidity(double areal_density, double bending_length);

/// A fabric from one's own measurement: mass per area and bending lengths, everything else as in
/// `base`. Throws DefinitionError on "fabric.areal_density", "fabric.bending_length_warp" or
/// "fabric.bending_length_weft" if a number is out of range.
/// @param areal_density  [kg/m^2], as of every fabric
/// @param warp,weft      bending lengths of strips cut along warp and weft [m], 0 to
/// kLongestBendingLength
FabricDef measured_fabric(const FabricDef& base, double areal_density, double warp, double weft);

/// The published band of the preset that has exactly these values; both 0 for all others.
DrapeBand published_drape(const FabricDef& fabric);

/// The preset that has exactly these values; "default" for those of a FabricDef as it is made;
/// "custom" for all others.
std::string fabric_name(const FabricDef& fabric);

}  // namespace weft
