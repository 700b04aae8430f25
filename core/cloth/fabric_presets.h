#pragma once

#include <string>
#include <vector>

#include "core/cloth/fabric.h"

// Named fabrics, and fabrics from measurements.

namespace weft {

/// Published drape coefficients of a kind of fabric [%].
struct DrapeBand {
  double low = 0, high = 0;  ///< both 0: none is known
};

/// A named fabric.
struct FabricPreset {
  const char* name;
  const char* description;
  FabricDef fabric;
  DrapeBand drape;  ///< of a 30 cm disc on an 18 cm support (BS 5058)
};

/// cotton, silk, wool, denim, leather, nylon. The source file cites the origin of the values.
const std::vector<FabricPreset>& fabric_presets();

/// Throws DefinitionError on field "fabric" if the name is unknown.
FabricDef make_fabric(const std::string& name);

inline constexpr double kLongestBendingLength = 0.2;  ///< largest accepted [m]

/// Bending rigidity of a fabric with this bending length, B = sigma g c^3 [N m] (ASTM D1388).
/// @param areal_density   sigma [kg/m^2]
/// @param bending_length  c [m]: half the overhang at which a strip droops by 41.5 degrees
double bending_rigidity(double areal_density, double bending_length);

/// A fabric from a measurement: mass per area and bending lengths, everything else as in `base`.
/// Throws DefinitionError on "fabric.areal_density", "fabric.bending_length_warp" or
/// "fabric.bending_length_weft" if a number is out of range.
/// @param areal_density  [kg/m^2], in the range of every fabric
/// @param warp,weft      bending lengths of strips cut along warp and weft [m], 0 to
///                       kLongestBendingLength
FabricDef measured_fabric(const FabricDef& base, double areal_density, double warp, double weft);

/// The published band of the preset with exactly these values; both 0 for all others.
DrapeBand published_drape(const FabricDef& fabric);

/// The preset with exactly these values; "default" for those of a default FabricDef; "custom" for
/// all others.
std::string fabric_name(const FabricDef& fabric);

}  // namespace weft
