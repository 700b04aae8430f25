// The slow path of a stop point.

#include "core/stop_signal.h"

namespace weft::detail {

void ask(StopSignal& signal) {
  // `attend` may itself do work with stop points.
  const StopScope nothing_else(nullptr);
  if (signal.attend()) throw Stopped();
}

}  // namespace weft::detail
