#pragma once

#include <cstdint>

#include "core/diagnostics/energies.h"
#include "core/diagnostics/energy_flows.h"
#include "core/solver/verlet.h"
#include "core/solver/work_meter.h"

// Where the cloth's energy came from and where it went.

namespace weft {

/// Energies of all cloths since measuring began [J].
struct EnergyBalance {
  std::uint64_t since = 0;  ///< tick at whose end measuring began
  double start = 0;         ///< total then
  EnergyFlows flows;
  double disturbances = 0;  ///< brought by those of the scene
  double commands = 0;      ///< brought by commands: other gravity or softness, pins that stop
  double sleep = 0;         ///< kinetic energy of cloth that fell asleep
  double recovery = 0;      ///< taken when cloth was stopped, in a tick that could not be computed
  Energies now;

  /// What no cause explains: lost by the solver if positive, brought by it if negative.
  double lost() const {
    return start + net(flows) + disturbances + commands - sleep - recovery - now.total();
  }
};

/// The balance of a world and the meter that feeds it, while they are wanted.
template <class Real>
struct EnergyLedger {
  WorkMeter<Real> meter;
  EnergyBalance balance;

  void begin(std::uint64_t tick, const Energies& now) {
    balance = {};
    balance.since = tick;
    balance.start = now.total();
    balance.now = now;
  }

  /// Books a tick that was accepted.
  /// @param brought  by disturbances just before it [J]
  void book(const AdvanceResult& tick, double brought) {
    balance.disturbances += brought;
    balance.commands += tick.before.total() - balance.now.total() - brought;
    balance.flows += meter.flows();
    balance.now = tick.after;
  }

  /// Books a change of the state at once as a loss.
  void book_loss(const Energies& now, double& loss) {
    loss += balance.now.total() - now.total();
    balance.now = now;
  }
};

}  // namespace weft
