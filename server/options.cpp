#include "server/options.h"

#include <algorithm>
#include <array>
#include <utility>

#include <boost/asio/ip/address.hpp>

namespace weft::server {
namespace {

std::string text_of(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void check_range(const char* field, double value, double minimum, double maximum) {
  // Written so that NaN fails as well.
  if (!(value >= minimum && value <= maximum))
    throw OptionError(field, text_of(value), text_of(minimum) + " to " + text_of(maximum));
}

}  // namespace

bool is_loopback(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

void validate(const ServerOptions& options) {
  boost::system::error_code error;
  boost::asio::ip::make_address(options.bind, error);
  if (error) throw OptionError("--bind", options.bind, "an IPv4 or IPv6 address");
  if (!is_loopback(options.bind) && !options.open)
    throw OptionError("--bind", options.bind,
                      "a loopback address such as 127.0.0.1, or any together with --open "
                      "(everyone who reaches the port may then command the cloth)");
  check_range("--port", options.port, 0, 65535);
  if (options.rate != 0) check_range("--rate", options.rate, 1, 1000);
  check_range("--threads", options.threads, 1, 64);
  check_range("--max-seconds", options.max_seconds, 0, 1e7);
  check_range("--max-viewers", options.limits.viewers, 1, 10000);
  check_range("--max-connections", options.limits.connections, 1, 100000);
  check_range("--max-connections-per-address", options.limits.connections_per_address, 1, 100000);
  check_range("--max-messages-per-second", options.limits.messages_per_second, 1, 1e6);
  static constexpr std::array<const char*, 6> kLevels = {"trace",   "debug", "info",
                                                         "warning", "error", "off"};
  if (std::find(kLevels.begin(), kLevels.end(), options.log_level) == kLevels.end())
    throw OptionError("--log-level", options.log_level,
                      "trace, debug, info, warning, error or off");
}

}  // namespace weft::server
