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

}  // namespace

void Metrics::count_tick(double seconds, bool rested) {
  const auto bound = std::lower_bound(kTickBounds.begin(), kTickBounds.end(), seconds);
  ++tick_counts_[static_cast<std::size_t>(bound - kTickBounds.begin())];
  ++ticks_;
  rested_ticks_ += rested ? 1U : 0U;
  tick_nanoseconds_ += static_cast<std::uint64_t>(seconds * 1e9);
}

void Metrics::count_frames(std::uint64_t sent, std::uint64_t dropped) {
  frames_sent_ += sent;
  frames_dropped_ += dropped;
}

void Metrics::count(std::map<std::string, std::uint64_t>& counts, const std::string& label) {
  const std::lock_guard lock(mutex_);
  ++counts[label];
}

std::string Metrics::text() const {
  std::ostringstream out;
  out.precision(9);
  single(out, "ticks_total", "counter", "Ticks simulated.", ticks_.load());
  single(out, "ticks_rested_total", "counter", "Ticks in which all cloth slept.",
         rested_ticks_.load());
  single(out, "ticks_halted_total", "counter", "Ticks that took too long and were given up.",
         halts_.load());
  single(out, "cloths_asleep", "gauge", "Sleeping cloths.", asleep_.load());
  head(out, "tick_seconds", "histogram", "Duration of a tick.");
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kTickBounds.size(); ++i) {
    below += tick_counts_[i];
    out << "weft_tick_seconds_bucket{le=\"" << kTickBounds[i] << "\"} " << below << '\n';
  }
  below += tick_counts_.back();
  out << "weft_tick_seconds_bucket{le=\"+Inf\"} " << below << '\n'
      << "weft_tick_seconds_sum " << static_cast<double>(tick_nanoseconds_) * 1e-9 << '\n'
      << "weft_tick_seconds_count " << below << '\n';
  single(out, "real_time_factor", "gauge", "Simulated time per real time.",
         real_time_factor_.load());
  single(out, "viewers", "gauge", "Connected viewers.", viewers_.load());
  single(out, "frames_sent_total", "counter", "Frames handed to viewers.", frames_sent_.load());
  single(out, "frames_dropped_total", "counter", "Frames replaced by newer ones before sending.",
         frames_dropped_.load());
  single(out, "bytes_sent_total", "counter", "WebSocket payload sent.", bytes_sent_.load());
  const std::lock_guard lock(mutex_);
  labelled(out, "commands_total", "Commands that reached the room.", "op", commands_);
  labelled(out, "errors_total", "Messages refused.", "code", errors_);
  return out.str();
}

}  // namespace weft::server
