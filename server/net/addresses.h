#pragma once

#include <string>
#include <vector>

#include <boost/asio/ip/address.hpp>

namespace weft::server {

/// Addresses of this machine's interfaces that are up, in the system's order; without loopback and
/// IPv6 link-local ones, which a browser cannot open.
std::vector<boost::asio::ip::address> interface_addresses();

/// Hosts, in URL form, under which a server that listens on `bind` can be opened: the address
/// itself, or for a wildcard (0.0.0.0 or ::) each of `interfaces` that it covers, IPv4 first. Never
/// empty: without any interface it is the loopback address.
std::vector<std::string> hosts_to_open(const std::string& bind,
                                       const std::vector<boost::asio::ip::address>& interfaces);

}  // namespace weft::server
