#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/tcp.hpp>

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
  double offset = 0;               ///< server's clock minus this process's [s]
  bool counting = false;           ///< arrivals count now
  std::vector<std::uint8_t> part;  ///< what was read last, of any viewer
};

enum class Opcode : std::uint8_t { text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

/// Cuts a stream of bytes into the messages of a WebSocket, of which it keeps no more than is
/// looked at: binary ones only as far as their header goes. Messages must not be in fragments.
class MessageReader {
 public:
  /// Takes what was read, and calls visit(opcode, start of the message, its length) for each
  /// message that ends in it.
  /// @return whether it could be read
  template <class Visit>
  bool take(std::span<const std::uint8_t> bytes, Visit&& visit) {
    while (!bytes.empty()) {
      const std::size_t used = inside_ ? add_payload(bytes) : add_head(bytes);
      bytes = bytes.subspan(used);
      if (broken_) return false;
      if (!inside_ || left_ > 0) continue;
      visit(opcode_, std::string_view(kept_), length_);
      kept_.clear();
      head_size_ = 0;
      inside_ = false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kKeptOfBinary = 128;  ///< bytes; the header of a frame is shorter

  std::size_t add_head(std::span<const std::uint8_t> bytes);
  std::size_t add_payload(std::span<const std::uint8_t> bytes);

  std::array<std::uint8_t, 10> head_{};
  std::size_t head_size_ = 0;
  bool inside_ = false, broken_ = false;  ///< of a message: its head is read; it is in fragments
  Opcode opcode_ = Opcode::text;
  std::uint64_t length_ = 0, left_ = 0;  ///< of the message [bytes]
  std::string kept_;
};

/// A viewer that acknowledges each frame and looks at its header alone, so that thousands of them
/// cost little: one system call reads a frame and one acknowledges it.
class Viewer {
 public:
  /// @param room  that it joins; empty: the default one
  Viewer(boost::asio::io_context& io, Plan& plan, const std::string& room)
      : socket_(io), plan_(plan),
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
  void ask_to_upgrade();
  void await_bytes();
  void on_readable();
  std::size_t end_of_upgrade(std::string_view bytes);
  void on_message(Opcode opcode, std::string_view start, std::uint64_t length);
  void on_frame(std::string_view start, std::uint64_t length);
  void on_text(std::string_view text);
  void send(Opcode opcode, std::string_view bytes);
  void write(std::string_view bytes);
  void lose(const std::string& reason);

  boost::asio::ip::tcp::socket socket_;
  Plan& plan_;
  std::string target_;
  std::string upgrade_;  ///< the server's answer to the request, as far as it has come
  bool upgraded_ = false, stalled_ = false, lost_ = false;
  MessageReader reader_;
  std::function<void()> on_ready_;
  std::function<void(const std::string&)> on_lost_;
  std::function<void(double, double)> on_offset_;
  Arrivals arrivals_;
};

}  // namespace weft::load
