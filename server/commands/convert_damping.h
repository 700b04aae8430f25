#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/options.h"

// `weft fabric`: what a fabric's damping makes of its modes, and which damping a measured mode has.

namespace weft::server {

inline constexpr OptionRange kStripLengths{0.001, 100};  // [m]
inline constexpr OptionRange kDecayTimes{1e-6, 1e6};     // [s]
inline constexpr OptionRange kLossFactors{0, 10};        // [1]

/// All options of `weft fabric`.
struct FabricOptions {
  std::vector<std::pair<std::string, std::string>> settings;  ///< `--set`, in order
  std::string mode;     ///< stretch, shear or bending; empty: all three as the fabric has them
  std::string form;     ///< grid or mesh; empty: mesh for a fabric with a poisson, else grid
  double length = 0.2;  ///< of the strip [m]
  std::optional<double> decay_time;   ///< measured, of the amplitude to 1/e [s]
  std::optional<double> loss_factor;  ///< measured [1]
  bool json = false;
};

/// Prints the frequency, decay time and loss factor that the modes of a strip have, or, with a
/// measured decay time or loss factor, the relaxation time that gives it.
/// Throws OptionError, of a decay that no setting has too, or DefinitionError.
int convert_damping(const FabricOptions& options);

}  // namespace weft::server
