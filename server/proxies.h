#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>

namespace weft::server {

/// A network such as 10.0.0.0/8 or fd00::/8, or one address.
class AddressRange {
 public:
  /// Nothing if the text is none.
  static std::optional<AddressRange> parse(const std::string& text);

  /// IPv4 addresses that are written as IPv6 ones count as what they are.
  bool contains(const boost::asio::ip::address& address) const;

 private:
  std::optional<boost::asio::ip::network_v4> v4_;
  std::optional<boost::asio::ip::network_v6> v6_;
};

/// What a request says of where it came from, a list of each field's values in order.
struct ForwardedFields {
  std::vector<std::string> x_forwarded_for;
  std::vector<std::string> forwarded;  ///< RFC 7239
};

/// The client that a trusted proxy forwarded a request for: of the addresses that the fields list,
/// the last that is no trusted proxy. Nothing if they list none, name what is no address, or do not
/// agree: then one of them is the client's own invention.
std::optional<boost::asio::ip::address> forwarded_client(const ForwardedFields& fields,
                                                         const std::vector<AddressRange>& trusted);

/// Under what an address is counted: itself, or the network of 64 bits of an IPv6 one, which
/// belongs to one customer.
std::string counted_as(const boost::asio::ip::address& address);

}  // namespace weft::server
