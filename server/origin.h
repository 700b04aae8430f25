#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::server {

/// host[:port], the host in lower case; IPv6 keeps its brackets.
struct Authority {
  std::string host;
  std::optional<int> port;  ///< none: the scheme's default
};

/// scheme://host[:port] as browsers send it, scheme and host in lower case.
struct Origin {
  std::string scheme;
  Authority authority;
};

/// None if the text is anything else: empty, with a user, a path, a space or a port above 65535.
std::optional<Authority> parse_authority(std::string_view text);
std::optional<Origin> parse_origin(std::string_view text);

/// Whether the host is independent of name servers: an IPv4 address in four decimal numbers, an
/// IPv6 address in brackets, or localhost.
bool is_fixed_host(const std::string& host);

/// Decides which pages may reach a server.
///
/// A browser lets a page talk to the server that it came from, and sends that server's name in
/// `Host`. The owner of a name can point it at any address, this server's too (DNS rebinding), but
/// cannot make a browser send another name. So requests are answered only under an IP address,
/// localhost, or the host of an allowed origin, on any port: forwarded ports keep working.
///
/// A socket accepts pages of other servers too, and names the page's in `Origin`. It is opened for
/// a page from the very host and port that the request names, for pages of the allowed origins, and
/// on the machine itself for those of the server's own port under any loopback name.
class OriginRules {
 public:
  /// @param allowed  origins, each with parse_origin
  /// @param port     the port that the server listens on
  OriginRules(const std::vector<std::string>& allowed, int port);

  bool host_allowed(const Authority& host) const;

  /// Whether a page of this origin may open a socket by a request with this host. The host must be
  /// allowed as well.
  bool origin_allowed(std::string_view origin, const Authority& host) const;

  /// Allowed hosts besides addresses, for an error.
  std::vector<std::string> allowed_hosts() const;

 private:
  std::vector<Origin> allowed_;
  int port_;
};

}  // namespace weft::server
