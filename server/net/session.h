#pragma once

#include <memory>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "server/net/service_context.h"

namespace weft::server {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Turns a connection whose upgrade request was accepted into a viewer of a room. The session keeps
/// itself alive until the connection ends.
/// @param early  bytes that followed the request; they belong to the first messages
void start_session(ServiceContext& context, std::shared_ptr<HostedRoom> room,
                   boost::asio::ip::tcp::socket socket, UpgradeRequest request,
                   const std::string& early, std::shared_ptr<ConnectionCount::Place> place);

}  // namespace weft::server
