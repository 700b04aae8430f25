#include "server/metrics.h"

#include <algorithm>
#include <sstream>

namespace weft::server {
namespace {

void head(std::ostream& out, const char* name, const char* type, const char* help) {
  out << "# HELP weft_" << name << ' ' << help << "\n# TYPE weft_" << name << ' ' << type << '\n';
}

template <class Value>
void single(std::ostream& out, const char* name, const char* type, const char* help, Value value) {
  head(out, name, type, help);
  out << "weft_" << name << ' ' << value << '\n';
}

void labelled(std::ostream& out, const char* name, const char* help, const char* label,
              const std::map<std::string, std::uint64_t>& counts) {
  head(out, name, "counter", help);
  for (const auto& [value, count] : counts)
    out << "weft_" << name << '{' << label << "=\"" << value << "\"} " << count << '\n';
}

std::uint64_t nanoseconds(double seconds) {
  return seconds > 0 ? static_cast<std::uint64_t>(seconds * 1e9) : 0;
}

using Bounds = std::array<double, Metrics::kTickBounds.size()>;

void add(Metrics::Histogram& histogram, const Bounds& bounds, double seconds) {
  const auto bound = std::lower_bound(bounds.begin(), bounds.end(), seconds);
  ++histogram[static_cast<std::size_t>(bound - bounds.begin())];
}

/// @param label  such as `room="default"`, or empty
void histogram(std::ostream& out, const std::string& name, const std::string& label,
               const Bounds& bounds, const Metrics::Histogram& counts,
               std::uint64_t total_nanoseconds) {
  const std::string comma = label.empty() ? "" : ",";
  const std::string braces = label.empty() ? "" : "{" + label + "}";
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    below += counts[i];
    out << "weft_" << name << "_bucket{" << label << comma << "le=\"" << bounds[i] << "\"} "
        << below << '\n';
  }
  below += counts.back();
  out << "weft_" << name << "_bucket{" << label << comma << "le=\"+Inf\"} " << below << '\n'
      << "weft_" << name << "_sum" << braces << ' ' << static_cast<double>(total_nanoseconds) * 1e-9
      << '\n'
      << "weft_" << name << "_count" << braces << ' ' << below << '\n';
}

}  // namespace

Metrics::~Metrics() {
  set_viewers(0);
  set_asleep(0);
}

void Metrics::count_tick(double seconds, double cpu, bool rested) {
  if (whole_) whole_->count_tick(seconds, cpu, rested);
  add(tick_counts_, kTickBounds, seconds);
  ++ticks_;
  rested_ticks_ += rested ? 1U : 0U;
  tick_nanoseconds_ += nanoseconds(seconds);
  tick_cpu_nanoseconds_ += nanoseconds(cpu);
}

void Metrics::count_late(double seconds) {
  if (whole_) whole_->count_late(seconds);
  add(late_counts_, kLateBounds, seconds);
  late_nanoseconds_ += nanoseconds(seconds);
}

void Metrics::count_cpu(double seconds) {
  if (whole_) whole_->count_cpu(seconds);
  cpu_nanoseconds_ += nanoseconds(seconds);
}

void Metrics::count_frames(std::uint64_t sent, std::uint64_t dropped) {
  if (whole_) whole_->count_frames(sent, dropped);
  frames_sent_ += sent;
  frames_dropped_ += dropped;
}

void Metrics::count_bytes(std::uint64_t sent) {
  if (whole_) whole_->count_bytes(sent);
  bytes_sent_ += sent;
}

void Metrics::count_halt() {
  if (whole_) whole_->count_halt();
  ++halts_;
}

void Metrics::count(Counts Metrics::*counts, const std::string& label) {
  if (whole_) whole_->count(counts, label);
  const std::lock_guard lock(mutex_);
  ++(this->*counts)[label];
}

/// The whole has the sum.
void Metrics::set(std::atomic<int> Metrics::*gauge, int value) {
  const int before = (this->*gauge).exchange(value);
  if (whole_) whole_->*gauge += value - before;
}

std::string Metrics::text(const std::vector<std::pair<std::string, const Metrics*>>& rooms) const {
  std::ostringstream out;
  out.precision(9);
  const auto of_each = [&](const char* name, const char* type, const char* help, auto&& value) {
    head(out, name, type, help);
    for (const auto& [room, metrics] : rooms)
      out << "weft_" << name << "{room=\"" << room << "\"} " << value(*metrics) << '\n';
  };
  single(out, "ticks_total", "counter", "Ticks simulated.", ticks_.load());
  single(out, "ticks_rested_total", "counter", "Ticks in which all cloth slept.",
         rested_ticks_.load());
  single(out, "ticks_halted_total", "counter", "Ticks that took too long and were given up.",
         halts_.load());
  single(out, "cloths_asleep", "gauge", "Sleeping cloths.", asleep_.load());
  head(out, "tick_seconds", "histogram", "Duration of a tick.");
  histogram(out, "tick_seconds", "", kTickBounds, tick_counts_, tick_nanoseconds_);
  double slowest = rooms.empty() ? 0 : rooms.front().second->real_time_factor_.load();
  for (const auto& [room, metrics] : rooms) {
    const double factor = metrics->real_time_factor_;
    if (factor > 0) slowest = slowest > 0 ? std::min(slowest, factor) : factor;
  }
  single(out, "real_time_factor", "gauge", "Simulated time per real time, of the slowest room.",
         slowest);
  single(out, "viewers", "gauge", "Connected viewers.", viewers_.load());
  single(out, "frames_sent_total", "counter", "Frames handed to viewers.", frames_sent_.load());
  single(out, "frames_dropped_total", "counter", "Frames replaced by newer ones before sending.",
         frames_dropped_.load());
  single(out, "bytes_sent_total", "counter", "WebSocket payload sent.", bytes_sent_.load());
  single(out, "rooms", "gauge", "Open rooms.", rooms.size());
  single(out, "tick_cpu_seconds_total", "counter", "CPU time of the rooms' ticks.",
         static_cast<double>(tick_cpu_nanoseconds_) * 1e-9);
  single(out, "cpu_seconds_total", "counter", "CPU time of the rooms' turns.",
         static_cast<double>(cpu_nanoseconds_) * 1e-9);
  of_each("room_ticks_total", "counter", "Ticks simulated.",
          [](const Metrics& room) { return room.ticks_.load(); });
  of_each("room_cpu_seconds_total", "counter", "CPU time of the room's turns.",
          [](const Metrics& room) { return static_cast<double>(room.cpu_nanoseconds_) * 1e-9; });
  of_each("room_real_time_factor", "gauge", "Simulated time per real time.",
          [](const Metrics& room) { return room.real_time_factor_.load(); });
  of_each("room_viewers", "gauge", "Connected viewers.",
          [](const Metrics& room) { return room.viewers_.load(); });
  head(out, "tick_late_seconds", "histogram", "How late ticks begin.");
  for (const auto& [room, metrics] : rooms)
    histogram(out, "tick_late_seconds", "room=\"" + room + "\"", kLateBounds, metrics->late_counts_,
              metrics->late_nanoseconds_);
  const std::lock_guard lock(mutex_);
  labelled(out, "commands_total", "Commands that reached the rooms.", "op", commands_);
  labelled(out, "errors_total", "Messages refused.", "code", errors_);
  return out.str();
}

}  // namespace weft::server
