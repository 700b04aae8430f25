#pragma once

#include <string>
#include <vector>

#include "core/cloth/fabric.h"

// Named fabrics, and rigidity from a bending length.

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

/// The published band of the preset with exactly these values; both 0 for all others.
DrapeBand published_drape(const FabricDef& fabric);

/// The preset with exactly these values; "default" for those of a default FabricDef; "custom" for
/// all others.
std::string fabric_name(const FabricDef& fabric);

}  // namespace weft
