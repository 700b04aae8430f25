#include "server/options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <thread>
#include <utility>

#include <boost/asio/ip/address.hpp>

#include "server/origin.h"
#include "server/proxies.h"

namespace weft::server {
namespace {

std::string text_of(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

template <class Number>
Number parse(const char* field, const std::string& text, const OptionRange& range,
             const char* kind) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || text.empty() ||
      !(static_cast<double>(value) >= range.minimum && static_cast<double>(value) <= range.maximum))
    throw OptionError(field, text, kind + (" from " + range.text()));
  return value;
}

}  // namespace

std::string OptionRange::text() const {
  return text_of(minimum) + " to " + text_of(maximum);
}

void check_range(const char* field, double value, const OptionRange& range) {
  // Written so that NaN fails too.
  if (!(value >= range.minimum && value <= range.maximum))
    throw OptionError(field, text_of(value), range.text());
}

int parse_whole_number(const char* field, const std::string& text, const OptionRange& range) {
  return parse<int>(field, text, range, "a whole number");
}

double parse_number(const char* field, const std::string& text, const OptionRange& range) {
  return parse<double>(field, text, range, "a number");
}

int usual_threads() {
  return std::thread::hardware_concurrency() > 1 ? 2 : 1;
}

bool is_loopback(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

void validate(const ServerOptions& options) {
  boost::system::error_code error;
  boost::asio::ip::make_address(options.bind, error);
  if (error) throw OptionError("--bind", options.bind, "an IPv4 or IPv6 address");
  if (!is_loopback(options.bind) && !options.open && !options.has_tokens)
    throw OptionError("--bind", options.bind,
                      "a loopback address such as 127.0.0.1, or any together with --tokens or "
                      "--open (everyone who reaches the port may then command the cloth)");
  check_range("--port", options.port, kPorts);
  if (options.rate != 0) check_range("--rate", options.rate, kRates);
  check_range("--threads", options.threads, kThreadCounts);
  check_range("--count-crossings", options.count_crossings, kCountPauses);
  check_range("--tick-limit", options.tick_limit, kTickLimits);
  check_range("--max-seconds", options.max_seconds, kRunSeconds);
  check_range("--rooms", options.rooms, kRoomCounts);
  check_range("--room-idle", options.room_idle, kRoomIdles);
  check_range("--max-viewers", options.limits.viewers, kViewerCounts);
  check_range("--max-connections", options.limits.connections, kSocketCounts);
  check_range("--max-connections-per-address", options.limits.connections_per_address,
              kSocketCounts);
  check_range("--max-messages-per-second", options.limits.messages_per_second, kMessageRates);
  check_range("--pong-seconds", options.limits.pong_seconds, kPongSeconds);
  for (const std::string& origin : options.allowed_origins) {
    if (!parse_origin(origin))
      throw OptionError("--allow-origin", origin,
                        "an origin such as https://weft.example or http://localhost:3000");
  }
  for (const std::string& proxy : options.trusted_proxies) {
    if (!AddressRange::parse(proxy))
      throw OptionError("--trusted-proxy", proxy,
                        "an address such as 127.0.0.1, or a network such as 10.0.0.0/8");
  }
  static constexpr std::array<const char*, 6> kLevels = {"trace",   "debug", "info",
                                                         "warning", "error", "off"};
  if (std::find(kLevels.begin(), kLevels.end(), options.log_level) == kLevels.end())
    throw OptionError("--log-level", options.log_level,
                      "trace, debug, info, warning, error or off");
}

}  // namespace weft::server
