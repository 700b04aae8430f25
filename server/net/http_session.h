#pragma once

#include <memory>

#include <boost/asio/ip/tcp.hpp>

#include "server/net/service_context.h"

namespace weft::server {

/// Serves one HTTP connection until it ends or becomes a WebSocket connection. The session keeps
/// itself alive.
/// @param refuse  answer every request with 503, because there are too many connections
void start_http_session(ServiceContext& context, boost::asio::ip::tcp::socket socket,
                        std::shared_ptr<ConnectionCount::Place> place, bool refuse);

}  // namespace weft::server
