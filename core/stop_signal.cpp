// The slow path of a stop point.

#include "core/stop_signal.h"

#include <cassert>

namespace weft::detail {

void ask(StopSignal& signal) {
  assert(signal.attend && "set before the signal is raised");
  // `attend` may itself do work with stop points.
  const StopScope nothing_else(nullptr);
  if (signal.attend()) throw Stopped();
}

}  // namespace weft::detail
