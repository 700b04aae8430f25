#pragma once

#include <cstdint>

// How the implicit solver leaves a tick.

namespace weft {

enum class ImplicitStatus : std::uint8_t {
  done,
  unsolved,  ///< done, but with a linear system that was not solved
  violent,   ///< given up: its steps would have dissipated or brought too much energy
  touching,  ///< given up: something touched, or could have
  driven,    ///< given up: a pin moved, which acts between two of its steps and is not in them
};

/// Whether another solver has to step the tick.
constexpr bool given_up(ImplicitStatus status) {
  return status >= ImplicitStatus::violent;
}

}  // namespace weft
