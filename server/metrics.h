#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace weft::server {

/// The service's counters about itself, for Prometheus. Safe from both threads.
class Metrics {
 public:
  /// Upper bounds of the histogram of tick times [s].
  static constexpr std::array<double, 11> kTickBounds = {
      0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25};

  /// @param rested  whether all cloth slept, so that the tick computed nothing
  void count_tick(double seconds, bool rested = false);
  void count_command(const std::string& op) { count(commands_, op); }
  void count_error(const std::string& code) { count(errors_, code); }
  void count_frames(std::uint64_t sent, std::uint64_t dropped);
  void count_bytes(std::uint64_t sent) { bytes_sent_ += sent; }
  void count_halt() { ++halts_; }
  void set_asleep(int cloths) { asleep_ = cloths; }
  void set_viewers(int viewers) { viewers_ = viewers; }
  void set_real_time_factor(double factor) { real_time_factor_ = factor; }

  /// In Prometheus' text exposition format.
  std::string text() const;

 private:
  void count(std::map<std::string, std::uint64_t>& counts, const std::string& label);

  std::array<std::atomic<std::uint64_t>, kTickBounds.size() + 1> tick_counts_{};
  std::atomic<std::uint64_t> ticks_{0}, rested_ticks_{0}, tick_nanoseconds_{0}, halts_{0};
  std::atomic<std::uint64_t> frames_sent_{0}, frames_dropped_{0}, bytes_sent_{0};
  std::atomic<int> viewers_{0}, asleep_{0};
  std::atomic<double> real_time_factor_{0};
  mutable std::mutex mutex_;  // of the maps
  std::map<std::string, std::uint64_t> commands_, errors_;
};

}  // namespace weft::server
