#pragma once

#include <chrono>
#include <functional>

namespace weft::server {

/// Monotonic time [s]. A parameter wherever time decides something, so that tests bring their own.
using Clock = std::function<double()>;

/// The clock of the process: seconds since its first use. Frames, `welcome` and `ping` speak of it.
inline double process_seconds() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The moment of the process clock as a time point of the standard library, for waiting.
inline std::chrono::steady_clock::time_point time_point_of(double seconds) {
  const auto left = std::chrono::duration<double>(seconds - process_seconds());
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(left);
}

}  // namespace weft::server
