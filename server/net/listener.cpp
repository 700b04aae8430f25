#include "server/net/listener.h"

#include <chrono>
#include <utility>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <spdlog/spdlog.h>

#include "server/net/http_session.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

// Sockets beyond the limit that get a refusal; further ones are closed without one.
constexpr int kMostRefusals = 32;
constexpr auto kComplaintPause = std::chrono::seconds(30);

}  // namespace

Listener::Listener(asio::io_context& io, ServiceContext& context)
    : context_(context), acceptor_(io), pause_(io) {
  const tcp::endpoint endpoint(asio::ip::make_address(context.options.bind),
                               static_cast<unsigned short>(context.options.port));
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(asio::socket_base::reuse_address(true));
  // On every system :: accepts IPv4 too, whatever its default.
  if (endpoint.address().is_v6()) acceptor_.set_option(asio::ip::v6_only(false));
  acceptor_.bind(endpoint);
  acceptor_.listen();
}

void Listener::stop() {
  boost::system::error_code ignored;
  acceptor_.close(ignored);
  pause_.cancel();
}

void Listener::accept() {
  acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted || !acceptor_.is_open()) return;
    if (error) {
      // Most likely out of file descriptors: other connections have to end first.
      complain(error.message());
      pause_.expires_after(std::chrono::milliseconds(100));
      pause_.async_wait([this](boost::system::error_code stopped) {
        if (!stopped) accept();
      });
      return;
    }
    welcome(std::move(socket));
    accept();
  });
}

void Listener::complain(const std::string& why) {
  const auto now = std::chrono::steady_clock::now();
  ++failures_;
  if (now < next_complaint_) return;
  next_complaint_ = now + kComplaintPause;
  spdlog::warn(
      "no connection can be accepted: {} (failed attempts since the last such message: {})", why,
      failures_);
  failures_ = 0;
}

void Listener::welcome(tcp::socket socket) {
  boost::system::error_code error;
  const tcp::endpoint remote = socket.remote_endpoint(error);
  if (error) return;  // already closed
  const std::string address = counted_as(remote.address());
  const ConnectionLimits& limits = context_.options.limits;
  // That of a proxy is known to be shared; each request tells whom it is for.
  const bool full = context_.connections.total() >= limits.connections ||
                    (!context_.trusts(remote.address()) &&
                     context_.connections.of_address(address) >= limits.connections_per_address);
  if (context_.connections.total() >= limits.connections + kMostRefusals) return;
  start_http_session(context_, std::move(socket), context_.connections.take_place(address), full);
}

}  // namespace weft::server
