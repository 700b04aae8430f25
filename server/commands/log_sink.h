#pragma once

#include <cstdint>
#include <mutex>
#include <string_view>

#include <spdlog/sinks/base_sink.h>

namespace weft::server {

/// Writes log lines to a descriptor without ever blocking, so that a stalled reader of standard
/// error does not stop the physics. A line that does not fit into a full pipe is lost; the next
/// line that fits is preceded by the number of lost ones. Lines longer than a pipe's atomic write
/// are cut.
///
/// It polls before it writes. If another process fills the same pipe in between, the write blocks
/// after all.
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
  std::uint64_t lost_ = 0;  ///< lines since the last one written
};

}  // namespace weft::server
