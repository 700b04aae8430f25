#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::server {

/// host[:port], the host in small letters; IPv6 keeps its brackets.
struct Authority {
  std::string host;
  std::optional<int> port;  ///< none: the usual one of the scheme
};

/// scheme://host[:port] as browsers send it, both parts in small letters.
struct Origin {
  std::string scheme;
  Authority authority;
};

/// None if the text is not exactly that: empty, with a user, a path, a space or a port above 65535.
std::optional<Authority> parse_authority(std::string_view text);
std::optional<Origin> parse_origin(std::string_view text);

/// Whether no name server had a part in it: an IPv4 address in four decimal numbers, an IPv6
/// address in brackets, or localhost.
bool is_fixed_host(const std::string& host);

/// Which pages may reach a server.
///
/// A browser lets a page talk to the server that it came from, and tells that server's name in
/// `Host`. Whoever owns a name can point it at any address, this server's too (DNS rebinding), but
/// cannot make a browser send another name. So a request is answered only under an address,
/// localhost, or the host of an allowed origin, whatever the port: forwarded ports keep working.
///
/// A socket takes pages of other servers too, and names the page's in `Origin`. It is opened for a
/// page that came from the very host and port that the request names, for pages of the allowed
/// origins, and on the machine itself for those of the server's own port under any loopback name.
class OriginRules {
 public:
  /// @param allowed  origins, each with parse_origin
  /// @param port     that is listened on
  OriginRules(const std::vector<std::string>& allowed, int port);

  bool host_allowed(const Authority& host) const;

  /// Whether a page of this origin may open a socket by a request with this host. The host has to
  /// be allowed itself.
  bool origin_allowed(std::string_view origin, const Authority& host) const;

  /// Hosts beside addresses, for an error.
  std::vector<std::string> allowed_hosts() const;

 private:
  std::vector<Origin> allowed_;
  int port_;
};

}  // namespace weft::server
