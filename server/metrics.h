#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace weft::server {

/// Counters of a room, or of all rooms together, for Prometheus. Safe from all threads.
class Metrics {
 public:
  /// Upper bounds of the histogram of tick times [s].
  static constexpr std::array<double, 11> kTickBounds = {
      0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25};
  /// The same of how late ticks begin [s].
  static constexpr std::array<double, 11> kLateBounds = {
      0.0001, 0.00025, 0.0005, 0.001, 0.0015, 0.002, 0.0025, 0.003, 0.005, 0.01, 0.05};
  using Histogram = std::array<std::atomic<std::uint64_t>, kTickBounds.size() + 1>;

  /// @param whole  counts the same beside those of others; outlives this; may be null
  explicit Metrics(Metrics* whole = nullptr) : whole_(whole) {}
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// @param rested  whether all cloth slept, so that the tick computed nothing
  /// @param seconds,cpu  that the tick took, and the CPU time of its thread [s]
  void count_tick(double seconds, double cpu, bool rested = false);
  /// @param seconds  between the time when a tick was due and its begin
  void count_late(double seconds);
  /// CPU time of the room's turns: ticks, commands and what is told [s]
  void count_cpu(double seconds);
  void count_command(const std::string& op) { count(&Metrics::commands_, op); }
  void count_error(const std::string& code) { count(&Metrics::errors_, code); }
  void count_frames(std::uint64_t sent, std::uint64_t dropped);
  void count_bytes(std::uint64_t sent);
  void count_halt();
  void set_asleep(int cloths) { set(&Metrics::asleep_, cloths); }
  void set_viewers(int viewers) { set(&Metrics::viewers_, viewers); }
  void set_real_time_factor(double factor) { real_time_factor_ = factor; }

  /// In Prometheus' text exposition format: these for all rooms, and some figures of each.
  std::string text(const std::vector<std::pair<std::string, const Metrics*>>& rooms = {}) const;

 private:
  using Counts = std::map<std::string, std::uint64_t>;

  void count(Counts Metrics::*counts, const std::string& label);
  void set(std::atomic<int> Metrics::*gauge, int value);

  Metrics* whole_;
  Histogram tick_counts_{}, late_counts_{};
  std::atomic<std::uint64_t> ticks_{0}, rested_ticks_{0}, tick_nanoseconds_{0}, halts_{0};
  std::atomic<std::uint64_t> tick_cpu_nanoseconds_{0};
  std::atomic<std::uint64_t> late_nanoseconds_{0}, cpu_nanoseconds_{0};
  std::atomic<std::uint64_t> frames_sent_{0}, frames_dropped_{0}, bytes_sent_{0};
  std::atomic<int> viewers_{0}, asleep_{0};
  std::atomic<double> real_time_factor_{0};
  mutable std::mutex mutex_;  // of the maps
  Counts commands_, errors_;
};

}  // namespace weft::server
