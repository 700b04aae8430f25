#pragma once

#include <utility>

#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "server/net/lingering_close.h"

// How a WebSocket over a buffered stream closes.

namespace boost::beast {

// Beast closes a stream through these; its buffered stream has no overloads. The overload for a
// socket, in Boost 1.74, closes after the first read even if there is more to read.
template <class Buffer, class Handler>
void async_teardown(role_type, buffered_read_stream<tcp_stream, Buffer>& stream,
                    Handler&& handler) {
  weft::server::async_lingering_close(stream.next_layer(), std::forward<Handler>(handler));
}

template <class NextLayer, class Buffer>
void beast_close_socket(buffered_read_stream<NextLayer, Buffer>& stream) {
  close_socket(stream.next_layer());
}

}  // namespace boost::beast
