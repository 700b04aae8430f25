#include "server/room/command_log.h"

#include <cstdint>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/server/fakes.h"

// What the log of a room keeps, and as what an advance that ends early counts in it.

namespace weft::server {
namespace {

TEST_CASE("the log keeps its newest entries and says by the index that older ones are gone") {
  CommandLog log(10);
  for (std::uint64_t i = 0; i < 25; ++i)
    log.add(i, 1, CommandOrigin::viewer, proto::Command(proto::Pause{}));
  CHECK(log.entries().size() == 10);
  CHECK(log.entries().front().index == 15);
  CHECK(log.entries().back().index == 24);
}

TEST_CASE("a log that lost only an advance without ticks still tells the whole history") {
  CommandLog log(2);
  log.add(0, 1, CommandOrigin::viewer, proto::Advance{5, std::nullopt, std::nullopt});
  log.shorten_advance(5);
  log.add(0, 1, CommandOrigin::viewer, proto::Command(proto::Pause{}));
  log.add(0, 1, CommandOrigin::viewer, proto::Command(proto::Resume{}));
  CHECK(log.complete());
  log.add(1, 1, CommandOrigin::viewer, proto::Command(proto::Pause{}));
  CHECK_FALSE(log.complete());
}

TEST_CASE("an advance that ends early counts in the log as the ticks that it made") {
  const std::uint32_t left = GENERATE(0u, 1u, 7u, 10u);
  CommandLog log;
  log.add(3, 1, CommandOrigin::viewer, proto::Advance{4, std::nullopt, std::nullopt});
  log.add(7, 1, CommandOrigin::viewer, proto::Advance{10, std::nullopt, std::nullopt});
  log.add(9, 2, CommandOrigin::viewer, proto::Pause{});
  log.shorten_advance(left);
  std::vector<std::uint32_t> made;
  for (const LogEntry& entry : log.entries())
    if (const auto* advance = std::get_if<proto::Advance>(&entry.command))
      made.push_back(advance->n);
  CHECK(made ==
        (left < 10 ? std::vector<std::uint32_t>{4, 10 - left} : std::vector<std::uint32_t>{4}));
  CHECK(std::holds_alternative<proto::Pause>(log.entries().back().command));
}

TEST_CASE("what is left of an advance whose viewer goes is no part of the log") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.room->take({1, 1, *proto::parse_request(R"({"op":"advance","n":5000})")});
  t.room->advance_until(t.clock.now);
  const auto ticks = static_cast<std::uint32_t>(t.room->world().tick());
  REQUIRE(ticks > 0);
  REQUIRE(ticks < 5000);
  t.room->take({1, 2, Leave{}});
  t.room->finish_turn();
  REQUIRE_FALSE(t.room->advancing());
  const auto& entries = t.room->log().entries();
  REQUIRE(std::holds_alternative<proto::Advance>(entries.front().command));
  CHECK(std::get<proto::Advance>(entries.front().command).n == ticks);
}

}  // namespace
}  // namespace weft::server
