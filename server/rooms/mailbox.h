#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "server/room/inbound.h"

namespace weft::server {

/// The only hand-over from the network thread to the thread that has a room's turn.
class Mailbox {
 public:
  /// @param most_commands  of one viewer that may wait at a time
  explicit Mailbox(std::size_t most_commands) : most_commands_(most_commands) {}

  /// Called whenever an item was added or the mailbox was stopped or woken, on the thread that did
  /// so. Set it before the first of these.
  std::function<void()> on_arrival = [] {};

  /// Appends. False, with nothing added, if the viewer has too many commands waiting, tokens that it
  /// tells among them; other items are always accepted.
  bool put(Inbound item);

  /// Everything that has arrived since the last call, in order.
  std::vector<Inbound> take_all();

  /// Tells that a command taken earlier is finished and no longer counts as waiting.
  void finished(proto::ViewerId viewer);

  void stop();
  bool stopped() const;

 private:
  const std::size_t most_commands_;
  mutable std::mutex mutex_;
  std::vector<Inbound> items_;
  std::unordered_map<proto::ViewerId, std::size_t> waiting_;
  bool stopped_ = false;
};

}  // namespace weft::server
