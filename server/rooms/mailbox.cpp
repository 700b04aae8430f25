#include "server/rooms/mailbox.h"

#include <utility>

namespace weft::server {

bool Mailbox::put(Inbound item) {
  {
    const std::lock_guard lock(mutex_);
    if (std::holds_alternative<proto::Request>(item.what) ||
        std::holds_alternative<Grant>(item.what)) {
      std::size_t& waiting = waiting_[item.viewer];
      if (waiting >= most_commands_) return false;
      ++waiting;
    }
    items_.push_back(std::move(item));
  }
  on_arrival();
  return true;
}

std::vector<Inbound> Mailbox::take_all() {
  const std::lock_guard lock(mutex_);
  return std::exchange(items_, {});
}

void Mailbox::finished(proto::ViewerId viewer) {
  const std::lock_guard lock(mutex_);
  const auto found = waiting_.find(viewer);
  if (found != waiting_.end() && --found->second == 0) waiting_.erase(found);
}

void Mailbox::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  on_arrival();
}

bool Mailbox::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

}  // namespace weft::server
