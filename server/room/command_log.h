#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <iterator>
#include <utility>
#include <variant>

#include "proto/messages/commands.h"

namespace weft::server {

/// Why a command entered the order.
enum class CommandOrigin : std::uint8_t {
  viewer,  ///< sent by a client
  lease,   ///< a drag received no target for too long
  leave,   ///< its viewer left
  policy,  ///< its viewer may not hold the cloth any more
  budget,  ///< ticks exceeded the time budget, or fit it again
  limit,   ///< a tick exceeded its CPU limit, or became worthless, and was given up
};

/// One accepted command in its place: after state `tick` and before the next one.
struct LogEntry {
  std::uint64_t tick = 0;
  std::uint64_t index = 0;  ///< counts all commands of the room; never decreases
  proto::ViewerId viewer = 0;
  CommandOrigin origin = CommandOrigin::viewer;
  proto::Command command;
};

/// The total order of a room's commands. Scene and log are the whole history, because everything
/// that depends on wall time is logged as a command. Keeps the newest entries up to a bound.
class CommandLog {
 public:
  explicit CommandLog(std::size_t most_entries = 1 << 16) : most_entries_(most_entries) {}

  void add(std::uint64_t tick, proto::ViewerId viewer, CommandOrigin origin,
           proto::Command command) {
    entries_.push_back({tick, next_index_++, viewer, origin, std::move(command)});
    if (entries_.size() <= most_entries_) return;
    entries_.pop_front();
    complete_ = false;
  }

  /// Reduces the last `advance` by the `left` ticks that it did not make; removes it if it made
  /// none.
  void shorten_advance(std::uint32_t left) {
    const auto last = std::find_if(entries_.rbegin(), entries_.rend(), [](const LogEntry& entry) {
      return std::holds_alternative<proto::Advance>(entry.command);
    });
    if (left == 0 || last == entries_.rend()) return;
    auto& advance = std::get<proto::Advance>(last->command);
    if (advance.n > left)
      advance.n -= left;
    else
      entries_.erase(std::next(last).base());
  }

  /// The newest entries, for a fork: it goes on with the same numbers.
  CommandLog newest(std::size_t count) const {
    CommandLog log = *this;
    if (log.entries_.size() <= count) return log;
    log.entries_.erase(log.entries_.begin(),
                       log.entries_.end() - static_cast<std::ptrdiff_t>(count));
    log.complete_ = false;
    return log;
  }

  /// Oldest first.
  const std::deque<LogEntry>& entries() const { return entries_; }
  /// Whether no entry had to make room for newer ones, so that the log tells the whole history.
  bool complete() const { return complete_; }
  std::uint64_t next_index() const { return next_index_; }

 private:
  std::size_t most_entries_;
  std::deque<LogEntry> entries_;
  std::uint64_t next_index_ = 0;
  bool complete_ = true;
};

}  // namespace weft::server
