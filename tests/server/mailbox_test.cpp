#include "server/mailbox.h"

#include <catch2/catch.hpp>

namespace weft::server {
namespace {

TEST_CASE("the mailbox bounds the commands of one viewer and takes everything else") {
  Mailbox mailbox(3);
  const auto command = [](proto::ViewerId viewer) {
    return Inbound{viewer, 1, proto::Request{std::nullopt, proto::Command(proto::Pause{})}};
  };
  for (int i = 0; i < 3; ++i) CHECK(mailbox.put(command(1)));
  CHECK_FALSE(mailbox.put(command(1)));
  CHECK(mailbox.put(command(2)));
  CHECK(mailbox.put({1, 2, Noted{}}));
  CHECK(mailbox.put({1, 2, Leave{}}));
  CHECK(mailbox.take_all().size() == 6);
  CHECK_FALSE(mailbox.put(command(1)));  // taken is not yet done
  mailbox.finished(1);
  CHECK(mailbox.put(command(1)));
}

}  // namespace
}  // namespace weft::server
