#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

namespace weft::load {

/// Time of this process [s].
double now();

/// What is measured of one viewer.
struct Arrivals {
  std::uint64_t frames = 0, bytes = 0;
  std::uint32_t first = 0, last = 0;  ///< sequences
  std::vector<float> ages;            ///< of frames when they had arrived whole [s]
};

/// What all viewers share.
struct Plan {
  boost::asio::ip::tcp::endpoint server;
  std::string host;
  std::string codec = "packed";
  double offset = 0;      ///< server's clock minus this process's [s]
  bool counting = false;  ///< arrivals count now
};

/// A viewer that acknowledges each frame and looks at its header alone, so that thousands of them
/// cost little.
class Viewer {
 public:
  /// @param room  that it joins; empty: the default one
  Viewer(boost::asio::io_context& io, const Plan& plan, const std::string& room)
      : ws_(io), plan_(plan),
        target_(room.empty() ? "/ws?mesh=http" : "/ws/" + room + "?mesh=http") {}

  /// Joins, and goes on reading.
  /// @param on_ready  called with the first frame
  /// @param on_lost   called with the reason if the connection ends
  void start(std::function<void()> on_ready, std::function<void(const std::string&)> on_lost);

  /// Reads no more from now on.
  void stall() { stalled_ = true; }
  /// Asks for the server's clock; `on_offset` is called with the offset and the round trip [s].
  void ping(std::function<void(double, double)> on_offset);

  const Arrivals& arrivals() const { return arrivals_; }

 private:
  void read();
  void on_message();
  void on_frame(const std::uint8_t* bytes, std::size_t size);
  void on_text(const std::string& text);
  void send(std::string bytes, bool binary);
  void write_next();
  void lose(const std::string& reason);

  boost::beast::websocket::stream<boost::beast::tcp_stream> ws_;
  const Plan& plan_;
  std::string target_;
  boost::beast::flat_buffer incoming_;
  struct Outgoing {
    std::string bytes;
    bool binary;
  };
  std::vector<Outgoing> waiting_;
  bool writing_ = false, stalled_ = false, lost_ = false;
  std::function<void()> on_ready_;
  std::function<void(const std::string&)> on_lost_;
  std::function<void(double, double)> on_offset_;
  Arrivals arrivals_;
};

}  // namespace weft::load
