#pragma once

#include <cstdint>
#include <mutex>
#include <string_view>

#include <spdlog/sinks/base_sink.h>

namespace weft::server {

/// Writes log lines to a descriptor and never waits for it, so that a reader of standard error that
/// stands still does not stop the physics. A line that a full pipe does not take is lost; once it
/// takes lines again, one says how many were. Longer lines than a pipe takes whole are cut.
///
/// It asks before it writes. Another process that writes to the same pipe may get in between, and
/// then a line waits as it would have without this.
class LogSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit LogSink(int descriptor) : descriptor_(descriptor) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

  bool takes_a_line() const;
  void write(std::string_view line) const;
  void format_and_write(const spdlog::details::log_msg& message);

  int descriptor_;
  std::uint64_t lost_ = 0;  ///< lines since the last one that was written
};

}  // namespace weft::server
