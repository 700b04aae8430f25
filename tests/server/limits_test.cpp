#include <atomic>
#include <vector>

#include <catch2/catch.hpp>

#include "server/net/connection_count.h"
#include "server/net/rate_limit.h"
#include "server/options.h"
#include "server/thread_pool.h"

namespace weft::server {
namespace {

TEST_CASE("a rate limit lets a burst and then its rate pass") {
  RateLimit limit(100, 100);
  double now = 10;
  for (int i = 0; i < 100; ++i) CHECK(limit.take(now));
  CHECK_FALSE(limit.take(now));
  int passed = 0;
  for (int i = 0; i < 2000; ++i) passed += limit.take(now += 0.005) ? 1 : 0;  // twice the rate
  CHECK(passed >= 999);
  CHECK(passed <= 1001);
  now += 10;
  for (int i = 0; i < 100; ++i) CHECK(limit.take(now));
  CHECK_FALSE(limit.take(now));
  for (int i = 0; i < 500; ++i) limit.allow_one();
  for (int i = 0; i < 500; ++i) CHECK(limit.take(now));
  CHECK_FALSE(limit.take(now));
}

TEST_CASE("connections are counted by address while they live") {
  ConnectionCount count;
  auto a = count.take_place("1.2.3.4"), b = count.take_place("1.2.3.4");
  const auto c = count.take_place("::1");
  CHECK(count.total() == 3);
  CHECK(count.of_address("1.2.3.4") == 2);
  a.reset();
  b.reset();
  CHECK(count.of_address("1.2.3.4") == 0);
  CHECK(count.total() == 1);
}

std::string refusal(const ServerOptions& options) {
  try {
    validate(options);
  } catch (const OptionError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("options out of range are refused with field, value and what is allowed") {
  CHECK(refusal({}) == "");
  ServerOptions options;
  options.port = 70000;
  CHECK(refusal(options) == "--port = 70000: allowed is 0 to 65535");
  options = {};
  options.rate = 0.5;
  CHECK(refusal(options) == "--rate = 0.5: allowed is 1 to 1000");
  options = {};
  options.bind = "example.org";
  CHECK(refusal(options) == "--bind = example.org: allowed is an IPv4 or IPv6 address");
  options = {};
  options.threads = 0;
  CHECK(refusal(options) == "--threads = 0: allowed is 1 to 64");
}

TEST_CASE("only loopback may be bound to without --open") {
  ServerOptions options;
  for (const char* address : {"127.0.0.1", "127.9.9.9", "::1"}) {
    options.bind = address;
    CHECK(refusal(options) == "");
  }
  for (const char* address : {"0.0.0.0", "192.168.0.1", "::"}) {
    options.bind = address;
    options.open = false;
    CHECK(refusal(options).find("--open") != std::string::npos);
    options.open = true;
    CHECK(refusal(options) == "");
  }
}

TEST_CASE("a thread pool runs each chunk once, again and again") {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    for (int chunks : {0, 1, 2, 7, 100}) {
      std::vector<std::atomic<int>> runs(static_cast<std::size_t>(chunks));
      for (int round = 0; round < 50; ++round)
        run_chunks(&pool, chunks, [&runs](int chunk) { ++runs[static_cast<std::size_t>(chunk)]; });
      for (const auto& count : runs) CHECK(count == 50);
    }
  }
}

TEST_CASE("a thread pool has done a job when it says so, however short and many they are") {
  ThreadPool pool(3);
  for (int round = 0; round < 20000; ++round) {
    // Plain numbers, of another size each time: who is late would write where nothing is.
    std::vector<int> runs(static_cast<std::size_t>(1 + round % 9), 0);
    run_chunks(&pool, static_cast<int>(runs.size()),
               [&runs](int chunk) { ++runs[static_cast<std::size_t>(chunk)]; });
    REQUIRE(runs == std::vector<int>(runs.size(), 1));
  }
}

}  // namespace
}  // namespace weft::server
