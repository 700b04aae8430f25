// Whom a connection is counted for, behind a proxy and without one.

#include "server/proxies.h"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/net/connection_count.h"

namespace weft::server {
namespace {

namespace ip = boost::asio::ip;

std::vector<AddressRange> networks(const std::vector<std::string>& texts) {
  std::vector<AddressRange> list;
  for (const std::string& text : texts) list.push_back(AddressRange::parse(text).value());
  return list;
}

/// The client as text; empty if there is none.
std::string client(const ForwardedFields& fields, const std::vector<std::string>& trusted = {}) {
  const auto found = forwarded_client(fields, networks(trusted));
  return found ? found->to_string() : "";
}

}  // namespace

TEST_CASE("a network has the addresses that share its prefix, and no others") {
  const auto has = [](const char* network, const char* address) {
    return AddressRange::parse(network).value().contains(ip::make_address(address));
  };
  CHECK(has("10.0.0.0/8", "10.255.3.1"));
  CHECK_FALSE(has("10.0.0.0/8", "11.0.0.0"));
  CHECK(has("10.1.2.3/8", "10.9.9.9"));
  CHECK(has("192.0.2.7", "192.0.2.7"));
  CHECK_FALSE(has("192.0.2.7", "192.0.2.6"));
  CHECK(has("192.0.2.7", "::ffff:192.0.2.7"));
  CHECK(has("0.0.0.0/0", "203.0.113.9"));
  CHECK_FALSE(has("0.0.0.0/0", "2001:db8::1"));
  CHECK(has("2001:db8::/32", "2001:db8:ffff::1"));
  CHECK_FALSE(has("2001:db8::/32", "2001:db9::1"));
  for (const char* wrong : {"", "10.0.0.0/33", "10.0.0/8", "fd00::/129", "proxy.example",
                            "10.0.0.1/", "10.0.0.1/x", "10.0.0.1/-1"}) {
    CAPTURE(wrong);
    CHECK_FALSE(AddressRange::parse(wrong));
  }
}

TEST_CASE("the client is the last address in the list that is no trusted proxy") {
  CHECK(client({{"203.0.113.9"}, {}}) == "203.0.113.9");
  CHECK(client({{"198.51.100.1, 203.0.113.9"}, {}}) == "203.0.113.9");  // the first is its own word
  CHECK(client({{"198.51.100.1", "203.0.113.9"}, {}}) == "203.0.113.9");
  CHECK(client({{"203.0.113.9, 10.0.0.2,10.0.0.3"}, {}}, {"10.0.0.0/8"}) == "203.0.113.9");
  CHECK(client({{"10.0.0.2, 10.0.0.3"}, {}}, {"10.0.0.0/8"}) == "10.0.0.2");
  CHECK(client({{"203.0.113.9:4711"}, {}}) == "203.0.113.9");
  CHECK(client({{"[2001:db8::17]:4711"}, {}}) == "2001:db8::17");
  CHECK(client({{"2001:db8::17"}, {}}) == "2001:db8::17");
  CHECK(client({{"::ffff:203.0.113.9"}, {}}) == "203.0.113.9");
  CHECK(client({{}, {R"(for=198.51.100.1, For="203.0.113.9:80";proto=https;by=10.0.0.1)"}}) ==
        "203.0.113.9");
  CHECK(client({{}, {R"(proto=https;for="[2001:db8:cafe::17]:4711")"}}) == "2001:db8:cafe::17");
}

TEST_CASE("a list that names no address, or two that do not agree, tell of no client") {
  CHECK(client({}).empty());
  for (const char* wrong :
       {"", "unknown", "_hidden", "203.0.113.9:x", "203.0.113.256", "[2001:db8::1", "203.0.113.9,",
        "203.0.113.9, nonsense", "[2001:db8::1]x"}) {
    CAPTURE(wrong);
    CHECK(client({{wrong}, {}}).empty());
  }
  CHECK(client({{}, {"by=203.0.113.9"}}).empty());
  CHECK(client({{"203.0.113.9"}, {"for=198.51.100.1"}}).empty());
  CHECK(client({{"203.0.113.9"}, {"for=203.0.113.9"}}) == "203.0.113.9");
}

TEST_CASE("an IPv6 customer counts as one, and an IPv4 address as itself") {
  CHECK(counted_as(ip::make_address("2001:db8:1:2:3:4:5:6")) ==
        counted_as(ip::make_address("2001:db8:1:2:9::1")));
  CHECK(counted_as(ip::make_address("2001:db8:1:2::1")) !=
        counted_as(ip::make_address("2001:db8:1:3::1")));
  CHECK(counted_as(ip::make_address("::ffff:192.0.2.7")) == "192.0.2.7");
}

TEST_CASE("a socket counts for one address at a time, and as one in all") {
  ConnectionCount count;
  const auto place = count.take_place("10.0.0.1");
  place->move_to("192.0.2.7");
  CHECK(count.of_address("10.0.0.1") == 0);
  CHECK(count.of_address("192.0.2.7") == 1);
  place->move_to("192.0.2.7");
  CHECK(count.of_address("192.0.2.7") == 1);
  CHECK(count.total() == 1);
  const auto other = count.take_place("192.0.2.7");
  CHECK(count.of_address("192.0.2.7") == 2);
  CHECK(count.total() == 2);
}

}  // namespace weft::server
