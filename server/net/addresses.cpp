#include "server/net/addresses.h"

#include <algorithm>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>

namespace weft::server {
namespace {

namespace ip = boost::asio::ip;

std::string host_of(const ip::address& address) {
  if (address.is_v4()) return address.to_string();
  std::string host = "[";
  return host.append(address.to_string()).append("]");
}

ip::address address_of(const sockaddr& socket_address) {
  if (socket_address.sa_family == AF_INET)
    return ip::address_v4(
        ntohl(reinterpret_cast<const sockaddr_in&>(socket_address).sin_addr.s_addr));
  ip::address_v6::bytes_type bytes;
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(socket_address).sin6_addr;
  std::copy(std::begin(v6.s6_addr), std::end(v6.s6_addr), bytes.begin());
  return ip::address_v6(bytes);
}

}  // namespace

std::vector<ip::address> interface_addresses() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(first, &freeifaddrs);
  std::vector<ip::address> addresses;
  for (const ifaddrs* i = first; i; i = i->ifa_next) {
    if (!i->ifa_addr || !(i->ifa_flags & IFF_UP)) continue;
    if (i->ifa_addr->sa_family != AF_INET && i->ifa_addr->sa_family != AF_INET6) continue;
    const ip::address address = address_of(*i->ifa_addr);
    if (address.is_loopback() || (address.is_v6() && address.to_v6().is_link_local())) continue;
    addresses.push_back(address);
  }
  return addresses;
}

std::vector<std::string> hosts_to_open(const std::string& bind,
                                       const std::vector<ip::address>& interfaces) {
  const ip::address bound = ip::make_address(bind);
  if (!bound.is_unspecified()) return {host_of(bound)};
  std::vector<std::string> hosts;
  for (const ip::address& address : interfaces) {
    if (address.is_v4()) hosts.push_back(host_of(address));
  }
  for (const ip::address& address : interfaces) {
    if (address.is_v6() && bound.is_v6()) hosts.push_back(host_of(address));
  }
  if (hosts.empty()) hosts.emplace_back(bound.is_v6() ? "[::1]" : "127.0.0.1");
  return hosts;
}

}  // namespace weft::server
