#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/net/service_context.h"

namespace weft::server {

/// Accepts connections and counts them.
class Listener {
 public:
  /// Throws boost::system::system_error if it cannot listen on the address.
  Listener(boost::asio::io_context& io, ServiceContext& context);

  int port() const { return acceptor_.local_endpoint().port(); }
  void start() { accept(); }
  void stop();

 private:
  void accept();
  void complain(const std::string& why);
  void welcome(boost::asio::ip::tcp::socket socket);

  ServiceContext& context_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::chrono::steady_clock::time_point next_complaint_{};
  std::uint64_t failures_ = 0;  ///< failed accepts since the last complaint
};

}  // namespace weft::server
