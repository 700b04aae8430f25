// Whom a proxy forwards for, as far as its word counts.

#include "server/proxies.h"

#include <algorithm>
#include <cctype>

namespace weft::server {
namespace {

namespace ip = boost::asio::ip;

constexpr unsigned kCustomerBits = 64;  // of an IPv6 address

/// The IPv4 address that an IPv6 one stands for, or the address itself.
ip::address plain(const ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return ip::make_address_v4(ip::v4_mapped, address.to_v6());
  return address;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

/// The parts between separators that stand outside quotes.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] == '"') quoted = !quoted;
    if (i < text.size() && (quoted || text[i] != separator)) continue;
    parts.push_back(trimmed(text.substr(begin, i - begin)));
    begin = i + 1;
  }
  return parts;
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char x) { return x >= '0' && x <= '9'; });
}

/// An address without or with a port; an IPv6 one has brackets if it has a port.
std::optional<ip::address> parse_node(std::string_view text) {
  std::string_view host = text;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    host = text.substr(1, end - 1);
    const std::string_view rest = text.substr(end + 1);
    if (!rest.empty() && (rest.front() != ':' || !is_port(rest.substr(1)))) return std::nullopt;
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    const std::size_t colon = text.find(':');
    if (!is_port(text.substr(colon + 1))) return std::nullopt;
    host = text.substr(0, colon);
  }
  boost::system::error_code error;
  const ip::address address = ip::make_address(std::string(host), error);
  if (error) return std::nullopt;
  return plain(address);
}

/// The node of one element of `Forwarded`, such as for="[2001:db8::17]:4711";proto=https.
std::string_view node_of(std::string_view element) {
  for (const std::string_view pair : split(element, ';')) {
    const std::size_t equals = pair.find('=');
    if (equals != 3 || std::tolower(pair[0]) != 'f' || std::tolower(pair[1]) != 'o' ||
        std::tolower(pair[2]) != 'r')
      continue;
    std::string_view value = pair.substr(equals + 1);
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
    return value;
  }
  return {};
}

std::vector<std::string_view> elements(const std::vector<std::string>& values) {
  std::vector<std::string_view> list;
  for (const std::string& value : values)
    for (const std::string_view part : split(value, ',')) list.push_back(part);
  return list;
}

bool contains(const std::vector<AddressRange>& networks, const ip::address& address) {
  return std::any_of(networks.begin(), networks.end(),
                     [&](const AddressRange& network) { return network.contains(address); });
}

/// The last of the nodes that is no trusted proxy, or the first of all.
std::optional<ip::address> last_untrusted(const std::vector<std::string_view>& nodes,
                                          const std::vector<AddressRange>& trusted) {
  std::optional<ip::address> client;
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    client = parse_node(*node);
    if (!client || !contains(trusted, *client)) return client;
  }
  return client;
}

}  // namespace

std::optional<AddressRange> AddressRange::parse(const std::string& text) {
  boost::system::error_code error;
  AddressRange network;
  if (text.find('/') == std::string::npos) {
    const ip::address address = plain(ip::make_address(text, error));
    if (error) return std::nullopt;
    if (address.is_v4())
      network.v4_ = ip::network_v4(address.to_v4(), 32);
    else
      network.v6_ = ip::network_v6(address.to_v6(), 128);
    return network;
  }
  const auto v4 = ip::make_network_v4(text, error);
  if (!error) {
    network.v4_ = v4.canonical();
    return network;
  }
  const auto v6 = ip::make_network_v6(text, error);
  if (error) return std::nullopt;
  network.v6_ = v6.canonical();
  return network;
}

bool AddressRange::contains(const ip::address& address) const {
  const ip::address real = plain(address);
  if (real.is_v4())
    return v4_ && ip::network_v4(real.to_v4(), v4_->prefix_length()).canonical() == *v4_;
  return v6_ && ip::network_v6(real.to_v6(), v6_->prefix_length()).canonical() == *v6_;
}

std::optional<ip::address> forwarded_client(const ForwardedFields& fields,
                                            const std::vector<AddressRange>& trusted) {
  const std::vector<std::string_view> plain_nodes = elements(fields.x_forwarded_for);
  std::vector<std::string_view> nodes = elements(fields.forwarded);
  std::transform(nodes.begin(), nodes.end(), nodes.begin(), node_of);
  if (plain_nodes.empty()) return last_untrusted(nodes, trusted);
  const auto client = last_untrusted(plain_nodes, trusted);
  if (!nodes.empty() && last_untrusted(nodes, trusted) != client) return std::nullopt;
  return client;
}

std::string counted_as(const ip::address& address) {
  const ip::address real = plain(address);
  if (real.is_v4()) return real.to_string();
  return ip::network_v6(real.to_v6(), kCustomerBits).canonical().to_string();
}

}  // namespace weft::server
