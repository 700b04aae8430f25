#include "server/origin.h"

#include <algorithm>
#include <charconv>

#include <boost/asio/ip/address.hpp>

namespace weft::server {
namespace {

constexpr std::string_view kHostCharacters = "abcdefghijklmnopqrstuvwxyz0123456789.-_";
constexpr std::string_view kIpv6Characters = "abcdef0123456789:.";
constexpr std::string_view kSchemeCharacters = "abcdefghijklmnopqrstuvwxyz0123456789+-.";
constexpr std::size_t kLongestHost = 255;

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return small;
}

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

/// The address inside brackets.
std::optional<boost::asio::ip::address_v6> address_v6_of(std::string_view host) {
  if (host.size() < 2 || host.front() != '[' || host.back() != ']') return {};
  const std::string_view inside = host.substr(1, host.size() - 2);
  if (!consists_of(inside, kIpv6Characters)) return {};
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address_v6(std::string(inside), error);
  if (error) return {};
  return address;
}

std::optional<boost::asio::ip::address_v4> address_v4_of(const std::string& host) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address_v4(host, error);
  if (error) return {};
  return address;
}

bool is_loopback_host(const std::string& host) {
  if (host == "localhost") return true;
  if (const auto v6 = address_v6_of(host)) return v6->is_loopback();
  const auto v4 = address_v4_of(host);
  return v4 && v4->is_loopback();
}

std::optional<int> port_of(const Authority& authority, const std::string& scheme) {
  if (authority.port) return authority.port;
  if (scheme == "http") return 80;
  if (scheme == "https") return 443;
  return {};
}

bool same_place(const Authority& a, const Authority& b, const std::string& scheme) {
  return a.host == b.host && port_of(a, scheme) == port_of(b, scheme);
}

}  // namespace

std::optional<Authority> parse_authority(std::string_view text) {
  const std::size_t bracket = text.starts_with('[') ? text.find(']') : 0;
  if (bracket == std::string_view::npos) return {};
  const std::size_t colon = text.find(':', bracket);
  Authority authority{in_small_letters(text.substr(0, colon)), {}};
  const bool sound = bracket > 0 ? address_v6_of(authority.host).has_value()
                                 : consists_of(authority.host, kHostCharacters);
  if (!sound || authority.host.size() > kLongestHost) return {};
  if (colon == std::string_view::npos || colon + 1 == text.size()) return authority;
  const std::string_view digits = text.substr(colon + 1);
  int port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc() || end != digits.data() + digits.size() || port < 0 || port > 65535)
    return {};
  authority.port = port;
  return authority;
}

std::optional<Origin> parse_origin(std::string_view text) {
  const std::size_t colon = text.find("://");
  if (colon == std::string_view::npos) return {};
  const std::string scheme = in_small_letters(text.substr(0, colon));
  const std::optional<Authority> authority = parse_authority(text.substr(colon + 3));
  if (!consists_of(scheme, kSchemeCharacters) || !authority) return {};
  return Origin{scheme, *authority};
}

bool is_fixed_host(const std::string& host) {
  return host == "localhost" || address_v6_of(host) || address_v4_of(host);
}

OriginRules::OriginRules(const std::vector<std::string>& allowed, int port) : port_(port) {
  for (const std::string& text : allowed) {
    if (const auto origin = parse_origin(text)) allowed_.push_back(*origin);
  }
}

bool OriginRules::host_allowed(const Authority& host) const {
  return is_fixed_host(host.host) ||
         std::any_of(allowed_.begin(), allowed_.end(),
                     [&](const Origin& origin) { return origin.authority.host == host.host; });
}

bool OriginRules::origin_allowed(std::string_view origin, const Authority& host) const {
  const std::optional<Origin> page = parse_origin(origin);
  if (!page) return false;
  const auto same = [&](const Origin& other) {
    return other.scheme == page->scheme &&
           same_place(other.authority, page->authority, page->scheme);
  };
  if (std::any_of(allowed_.begin(), allowed_.end(), same)) return true;
  if (same_place(page->authority, host, page->scheme)) return true;
  return is_loopback_host(page->authority.host) && is_loopback_host(host.host) &&
         port_of(page->authority, page->scheme) == port_;
}

std::vector<std::string> OriginRules::allowed_hosts() const {
  std::vector<std::string> hosts = {"localhost"};
  for (const Origin& origin : allowed_) {
    if (is_fixed_host(origin.authority.host)) continue;
    if (std::find(hosts.begin(), hosts.end(), origin.authority.host) == hosts.end())
      hosts.push_back(origin.authority.host);
  }
  return hosts;
}

}  // namespace weft::server
