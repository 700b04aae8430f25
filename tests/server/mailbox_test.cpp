#include "server/rooms/mailbox.h"

#include <atomic>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

namespace weft::server {
namespace {

Inbound command_of(proto::ViewerId viewer, std::uint32_t number = 1) {
  return {viewer, number, proto::Request{std::nullopt, proto::Command(proto::Pause{})}};
}

TEST_CASE("the mailbox bounds commands and tokens of one viewer and takes everything else") {
  Mailbox mailbox(3);
  for (int i = 0; i < 3; ++i) CHECK(mailbox.put(command_of(1)));
  CHECK_FALSE(mailbox.put(command_of(1)));
  CHECK_FALSE(mailbox.put({1, 2, Grant{}}));
  CHECK(mailbox.put(command_of(2)));
  CHECK(mailbox.put({1, 2, Noted{}}));
  CHECK(mailbox.put({1, 2, Leave{}}));
  CHECK(mailbox.take_all().size() == 6);
  CHECK_FALSE(mailbox.put(command_of(1)));  // taken is not yet done
  mailbox.finished(1);
  CHECK(mailbox.put(command_of(1)));
}

/// What a reader has got while writers wrote: each viewer's numbers must be 1, 2, 3 and so on.
class Order {
 public:
  explicit Order(std::size_t viewers) : last_(viewers + 1, 0) {}
  void add(const Inbound& item) {
    in_order_ = in_order_ && item.number == last_.at(item.viewer) + 1;
    last_.at(item.viewer) = item.number;
    ++count_;
  }
  bool holds() const { return in_order_; }
  std::size_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> last_;
  bool in_order_ = true;
  std::size_t count_ = 0;
};

// Without the mailbox's lock this loses items, or ends in a crash, within the first thousand.
TEST_CASE("what several threads put in at once all comes out, once and in each one's order") {
  constexpr std::size_t kWriters = 3;
  constexpr std::uint32_t kItems = 30'000, kMostWaiting = 64;
  Mailbox mailbox(kMostWaiting);
  std::vector<std::thread> writers;
  for (proto::ViewerId viewer = 1; viewer <= kWriters; ++viewer) {
    writers.emplace_back([&mailbox, viewer] {
      for (std::uint32_t number = 1; number <= kItems; ++number) {
        if (number % 3 == 0) {
          mailbox.put({viewer, number, Noted{}});
          continue;
        }
        while (!mailbox.put(command_of(viewer, number))) std::this_thread::yield();
      }
    });
  }
  Order order(kWriters);
  std::vector<std::size_t> waiting(kWriters + 1, 0);
  bool bounded = true;
  while (order.count() < kWriters * kItems) {
    const std::vector<Inbound> items = mailbox.take_all();
    if (items.empty()) std::this_thread::yield();
    for (const Inbound& item : items) {
      order.add(item);
      if (std::holds_alternative<proto::Request>(item.what)) ++waiting[item.viewer];
    }
    for (const Inbound& item : items) {
      if (!std::holds_alternative<proto::Request>(item.what)) continue;
      bounded = bounded && waiting[item.viewer] <= kMostWaiting;
      --waiting[item.viewer];
      mailbox.finished(item.viewer);
    }
  }
  for (std::thread& writer : writers) writer.join();
  CHECK(order.count() == kWriters * kItems);
  CHECK(order.holds());
  CHECK(bounded);
  CHECK(mailbox.take_all().empty());
}

TEST_CASE("each item and the end are told on arrival, on the thread that brought them") {
  Mailbox mailbox(1);
  std::vector<std::thread::id> told;
  mailbox.on_arrival = [&told] { told.push_back(std::this_thread::get_id()); };
  mailbox.put({1, 1, Noted{}});
  CHECK(told.size() == 1);
  mailbox.put(command_of(1));
  CHECK_FALSE(mailbox.put(command_of(1)));  // refused, so nothing has arrived
  CHECK(told.size() == 2);
  CHECK_FALSE(mailbox.stopped());
  mailbox.stop();
  CHECK(mailbox.stopped());
  CHECK(told == std::vector<std::thread::id>(3, std::this_thread::get_id()));
}

}  // namespace
}  // namespace weft::server
