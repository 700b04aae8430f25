#pragma once

#include <netinet/tcp.h>
#include <utility>

#include <boost/asio/ip/tcp.hpp>

// What the kernel does with what is written to a viewer. Where it cannot, nothing else changes.

namespace weft::server {

inline void set_tcp_option(boost::asio::ip::tcp::socket& socket, int option, int value) {
  ::setsockopt(socket.native_handle(), IPPROTO_TCP, option, &value, sizeof value);
}

/// Keeps few unsent bytes of a viewer, so that frames stay fresh.
inline void keep_backlog_small(boost::asio::ip::tcp::socket& socket) {
  constexpr int kUnsent = 16 * 1024;
  set_tcp_option(socket, TCP_NOTSENT_LOWAT, kUnsent);
}

/// What is written and does not fill a segment.
class LastSegment {
 public:
  /// Keeps it until more follows, so that an observation and the answer after it wake the viewer
  /// once; or sends it.
  void keep(boost::asio::ip::tcp::socket& socket, bool keeps) {
    if (std::exchange(kept_, keeps) != keeps) set_tcp_option(socket, TCP_CORK, keeps ? 1 : 0);
  }

 private:
  bool kept_ = false;
};

}  // namespace weft::server
