#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace weft::server {

/// Counts open sockets, in total and per address. Lives on the network thread.
class ConnectionCount {
 public:
  /// Counts one socket for as long as it exists.
  class Place {
   public:
    Place(ConnectionCount& count, std::string address)
        : count_(count), address_(std::move(address)) {
      ++count_.total_;
      ++count_.by_address_[address_];
    }
    ~Place() {
      --count_.total_;
      leave_address();
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    const std::string& address() const { return address_; }
    /// Counts it for another address from now on: that of the client behind a proxy.
    void move_to(const std::string& address) {
      ++count_.by_address_[address];
      leave_address();
      address_ = address;
    }

   private:
    void leave_address() {
      const auto found = count_.by_address_.find(address_);
      if (--found->second == 0) count_.by_address_.erase(found);
    }

    ConnectionCount& count_;
    std::string address_;
  };

  std::shared_ptr<Place> take_place(const std::string& address) {
    return std::make_shared<Place>(*this, address);
  }

  int total() const { return total_; }
  int of_address(const std::string& address) const {
    const auto found = by_address_.find(address);
    return found == by_address_.end() ? 0 : found->second;
  }

 private:
  int total_ = 0;
  std::map<std::string, int> by_address_;
};

}  // namespace weft::server
