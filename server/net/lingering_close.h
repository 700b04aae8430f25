#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <utility>

#include <boost/asio/compose.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/tcp_stream.hpp>

namespace weft::server {

// Time and bytes that a closing connection may still cost.
inline constexpr std::chrono::seconds kLingerTime{5};
inline constexpr std::size_t kLingerBytes = 64 << 20;

/// Ends the sending half, then reads and discards until the peer has ended its own.
struct LingeringClose {
  using Part = std::array<char, 16 * 1024>;

  boost::beast::tcp_stream& stream;
  std::unique_ptr<Part> part = std::make_unique<Part>();
  std::size_t left = kLingerBytes;
  bool begun = false;

  template <class Self>
  void operator()(Self& self, boost::beast::error_code error = {}, std::size_t bytes = 0) {
    if (!std::exchange(begun, true)) {
      boost::beast::error_code ignored;  // reading notices a broken connection
      stream.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
      stream.expires_after(kLingerTime);
    }
    if (error || bytes >= left) {
      stream.close();
      return self.complete(error == boost::asio::error::eof ? boost::beast::error_code() : error);
    }
    left -= bytes;
    const auto room = boost::asio::buffer(*part);
    stream.async_read_some(room, std::move(self));
  }
};

/// Closes a connection so that the last message reaches the peer even if that is still sending: a
/// socket closed over unread bytes resets its connection, and the peer's system then discards what
/// the peer has not read yet (RFC 9112 section 9.6, RFC 1122 section 4.2.2.13). Bounded in time and
/// bytes; beyond them the connection is reset.
/// @param stream  no read or write may be pending; it must live until the handler is called
/// @param handler  called without error if the peer closed, else with the reason for the reset; the
///                 stream is closed in either case
template <class Handler>
auto async_lingering_close(boost::beast::tcp_stream& stream, Handler&& handler) {
  return boost::asio::async_compose<Handler, void(boost::beast::error_code)>(LingeringClose{stream},
                                                                             handler, stream);
}

}  // namespace weft::server
