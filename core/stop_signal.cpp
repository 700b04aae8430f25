#include "core/stop_signal.h"

namespace weft::detail {

void ask(StopSignal& signal) {
  // What attends may itself do work with stop points.
  const StopScope nothing_else(nullptr);
  if (signal.attend()) throw Stopped();
}

}  // namespace weft::detail
