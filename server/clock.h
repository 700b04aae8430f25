#pragma once

#include <chrono>
#include <functional>

namespace weft::server {

/// Monotonic time [s]. A parameter wherever time decides something, so that tests can replace it.
using Clock = std::function<double()>;

/// The clock of the process: seconds since its first use. Times in frames, `welcome` and `ping` are
/// on this clock.
inline double process_seconds() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Converts seconds to a duration of the standard library, for waiting.
inline std::chrono::steady_clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

/// Converts a process time to a time point of the standard library, for waiting.
inline std::chrono::steady_clock::time_point time_point_of(double seconds) {
  return std::chrono::steady_clock::now() + duration_of(seconds - process_seconds());
}

}  // namespace weft::server
