#include "server/commands/log_sink.h"

#include <algorithm>
#include <poll.h>
#include <string>
#include <unistd.h>

#include <climits>

namespace weft::server {

void LogSink::sink_it_(const spdlog::details::log_msg& message) {
  if (lost_ > 0 && takes_a_line()) {
    const std::string told =
        std::to_string(lost_) + " lines were lost, because standard error took none";
    spdlog::details::log_msg note(message.logger_name, spdlog::level::warn, told);
    format_and_write(note);
    lost_ = 0;
  }
  if (lost_ == 0 && takes_a_line())
    format_and_write(message);
  else
    ++lost_;
}

bool LogSink::takes_a_line() const {
  pollfd ready{descriptor_, POLLOUT, 0};
  return ::poll(&ready, 1, 0) == 1 && (ready.revents & POLLOUT) != 0;
}

void LogSink::format_and_write(const spdlog::details::log_msg& message) {
  spdlog::memory_buf_t line;
  formatter_->format(message, line);
  if (line.size() > PIPE_BUF) {
    line.resize(PIPE_BUF);
    line[PIPE_BUF - 1] = '\n';
  }
  write({line.data(), line.size()});
}

void LogSink::write(std::string_view line) const {
  // Written whole or not at all, since the line fits a pipe's atomic write; an error cannot be
  // reported anywhere.
  [[maybe_unused]] const ssize_t written = ::write(descriptor_, line.data(), line.size());
}

}  // namespace weft::server
