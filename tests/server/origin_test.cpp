#include "server/origin.h"

#include <catch2/catch.hpp>

#include "server/net/addresses.h"

namespace weft::server {
namespace {

constexpr int kPort = 8080;

bool answers(const OriginRules& rules, const char* host) {
  const auto authority = parse_authority(host);
  REQUIRE(authority);
  return rules.host_allowed(*authority);
}

bool opens(const OriginRules& rules, const char* origin, const char* host) {
  return answers(rules, host) && rules.origin_allowed(origin, *parse_authority(host));
}

TEST_CASE("a host is a name, an IPv4 address or an IPv6 address in brackets, and nothing else") {
  for (const char* text :
       {"a", "a.b-c_d", "LOCALHOST:1", "1.2.3.4:65535", "[::1]", "[FE80::1]:0", "a:", "0:0"}) {
    CAPTURE(text);
    CHECK(parse_authority(text));
  }
  for (const char* text : {"",          ":80",  "a:65536", "a:-1", "a:+1",     "a:8 ",
                           "a: 8",      "a:b",  "u@a",     "a/b",  "a,b",      "a b",
                           "::1",       "[::1", "[]",      "[a]x", "[::1]x:2", "[fe80::1%eth0]",
                           "[1.2.3.4]", "a\tb", "é",       "a?b",  "a#b"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_authority(text));
  }
  CHECK_FALSE(parse_authority(std::string(256, 'a')));
  CHECK(parse_authority("LocalHost:80")->host == "localhost");
}

TEST_CASE("a server answers under addresses and localhost with any port, and under no other name") {
  const OriginRules rules({}, kPort);
  for (const char* host : {"localhost", "LOCALHOST:9000", "127.0.0.1:8080", "127.0.0.1",
                           "[::1]:9000", "192.168.1.5:8080", "[2001:db8::1]:8080", "10.0.0.1"}) {
    CAPTURE(host);
    CHECK(answers(rules, host));
  }
  for (const char* host :
       {"evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example",
        "localhost.", "0x7f.1", "2130706433", "127.1"}) {
    CAPTURE(host);
    CHECK_FALSE(answers(rules, host));
  }
}

TEST_CASE("an allowed origin names a host that is answered to, with any port") {
  const OriginRules rules({"https://Weft.example", "http://localhost:3000"}, kPort);
  CHECK(answers(rules, "weft.example"));
  CHECK(answers(rules, "WEFT.EXAMPLE:8443"));
  CHECK_FALSE(answers(rules, "other.weft.example"));
  CHECK(rules.allowed_hosts() == std::vector<std::string>{"localhost", "weft.example"});
}

TEST_CASE("a page opens the socket where it came from, through any forwarded port") {
  const OriginRules rules({}, kPort);
  CHECK(opens(rules, "http://localhost:9000", "localhost:9000"));
  CHECK(opens(rules, "http://LOCALHOST:9000", "localhost:9000"));
  CHECK(opens(rules, "http://127.0.0.1:9000", "127.0.0.1:9000"));
  CHECK(opens(rules, "https://[::1]:9000", "[::1]:9000"));
  CHECK(opens(rules, "http://192.168.1.5:8080", "192.168.1.5:8080"));
  // The usual port of a scheme is not written by browsers.
  CHECK(opens(rules, "http://localhost", "localhost:80"));
  CHECK(opens(rules, "https://127.0.0.1", "127.0.0.1"));
  CHECK_FALSE(opens(rules, "https://localhost", "localhost:80"));
}

TEST_CASE("a page of another server does not open the socket") {
  const OriginRules rules({}, kPort);
  for (const char* origin :
       {"http://evil.example", "http://evil.example:8080", "null", "", "file://", "localhost:8080",
        "http://127.0.0.1.evil.example:8080", "http://localhost:9000", "http://127.0.0.1",
        "http://192.168.1.5:8080", "http://localhost:8080/", "http://u@localhost:8080"}) {
    CAPTURE(origin);
    CHECK_FALSE(opens(rules, origin, "127.0.0.1:8080"));
  }
  // What was pointed here by a name server is refused by its Host, which it cannot forge.
  CHECK_FALSE(opens(rules, "http://evil.example:8080", "evil.example:8080"));
}

TEST_CASE("on one machine the server's own port is one place under every loopback name") {
  const OriginRules rules({}, kPort);
  CHECK(opens(rules, "http://localhost:8080", "127.0.0.1:8080"));
  CHECK(opens(rules, "http://[::1]:8080", "localhost:8080"));
  CHECK_FALSE(opens(rules, "http://localhost:8081", "127.0.0.1:8080"));
  // On another machine the same words mean another server.
  CHECK_FALSE(opens(rules, "http://localhost:8080", "192.168.1.5:8080"));
}

TEST_CASE("an allowed origin opens the socket under any host that is answered to") {
  const OriginRules rules({"https://weft.example", "http://localhost:3000"}, kPort);
  CHECK(opens(rules, "https://weft.example", "weft.example"));
  CHECK(opens(rules, "https://weft.example", "127.0.0.1:8080"));  // a proxy that sets Host
  CHECK(opens(rules, "HTTPS://WEFT.EXAMPLE:443", "127.0.0.1:8080"));
  CHECK(opens(rules, "http://localhost:3000", "127.0.0.1:8080"));
  CHECK_FALSE(opens(rules, "http://weft.example", "127.0.0.1:8080"));
  CHECK_FALSE(opens(rules, "https://weft.example:8443", "127.0.0.1:8080"));
  CHECK_FALSE(opens(rules, "https://evil.example", "weft.example"));
}

TEST_CASE("a server on every address is opened by those of the interfaces, IPv4 first") {
  using boost::asio::ip::make_address;
  const std::vector<boost::asio::ip::address> interfaces = {
      make_address("2001:db8::5"), make_address("192.168.1.5"), make_address("10.0.0.2")};
  using Hosts = std::vector<std::string>;
  CHECK(hosts_to_open("0.0.0.0", interfaces) == Hosts{"192.168.1.5", "10.0.0.2"});
  CHECK(hosts_to_open("::", interfaces) == Hosts{"192.168.1.5", "10.0.0.2", "[2001:db8::5]"});
  CHECK(hosts_to_open("127.0.0.1", interfaces) == Hosts{"127.0.0.1"});
  CHECK(hosts_to_open("::1", interfaces) == Hosts{"[::1]"});
  CHECK(hosts_to_open("0.0.0.0", {}) == Hosts{"127.0.0.1"});
  CHECK(hosts_to_open("::", {}) == Hosts{"[::1]"});
  for (const auto& address : interface_addresses()) {
    CAPTURE(address.to_string());
    CHECK_FALSE(address.is_unspecified());
    CHECK_FALSE(address.is_loopback());
  }
}

}  // namespace
}  // namespace weft::server
