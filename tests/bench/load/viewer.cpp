#include "tests/bench/load/viewer.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>

#include "proto/binary.h"
#include "proto/frames/frame.h"
#include "proto/messages/data.h"

namespace weft::load {

namespace asio = boost::asio;
using boost::system::error_code;

double now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

std::size_t MessageReader::add_head(std::span<const std::uint8_t> bytes) {
  std::size_t used = 0;
  std::size_t needed = 2;
  while (used < bytes.size() && head_size_ < needed) {
    head_[head_size_++] = bytes[used++];
    if (head_size_ >= 2) needed = head_[1] == 127 ? 10 : head_[1] == 126 ? 4 : 2;
  }
  if (head_size_ < needed) return used;
  broken_ = (head_[0] & 0xf0) != 0x80 || head_[1] > 127;  // a fragment, an extension or a mask
  opcode_ = static_cast<Opcode>(head_[0] & 0x0f);
  length_ = head_[1] < 126 ? head_[1] : 0;
  for (std::size_t k = 2; k < needed; ++k) length_ = length_ * 256 + head_[k];
  left_ = length_;
  inside_ = true;
  return used;
}

std::size_t MessageReader::add_payload(std::span<const std::uint8_t> bytes) {
  const auto used = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
  left_ -= used;
  std::size_t kept = used;
  if (opcode_ == Opcode::binary) kept = std::min(used, kKeptOfBinary - kept_.size());
  kept_.append(reinterpret_cast<const char*>(bytes.data()), kept);
  return used;
}

void Viewer::start(std::function<void()> on_ready,
                   std::function<void(const std::string&)> on_lost) {
  on_ready_ = std::move(on_ready);
  on_lost_ = std::move(on_lost);
  socket_.async_connect(plan_.server, [this](error_code error) {
    if (error) return lose("connect: " + error.message());
    error_code ignored;
    socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
    socket_.non_blocking(true, ignored);
    ask_to_upgrade();
    await_bytes();
  });
}

/// The key is any: whether the server answers to it is not what is measured here.
void Viewer::ask_to_upgrade() {
  write("GET " + target_ + " HTTP/1.1\r\nHost: " + plan_.host +
        "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: d2VmdCBsb2FkIHZpZXdlcg==\r\nSec-WebSocket-Protocol: " +
        std::string(proto::kSubprotocol) + "\r\n\r\n");
}

void Viewer::ping(std::function<void(double, double)> on_offset) {
  on_offset_ = std::move(on_offset);
  send(Opcode::text, nlohmann::json{{"op", "ping"}, {"id", 1}, {"t", now()}}.dump());
}

void Viewer::await_bytes() {
  socket_.async_wait(asio::ip::tcp::socket::wait_read, [this](error_code error) {
    if (error) return lose("wait: " + error.message());
    if (!stalled_) on_readable();
  });
}

void Viewer::on_readable() {
  error_code error;
  const std::size_t size = socket_.read_some(asio::buffer(plan_.part), error);
  if (error && error != asio::error::would_block) return lose("read: " + error.message());
  std::span<const std::uint8_t> bytes(plan_.part.data(), size);
  if (!upgraded_)
    bytes = bytes.subspan(end_of_upgrade({reinterpret_cast<const char*>(bytes.data()), size}));
  const bool whole =
      reader_.take(bytes, [this](Opcode opcode, std::string_view start, std::uint64_t length) {
        on_message(opcode, start, length);
      });
  if (!whole) return lose("read: a message in fragments");
  if (!lost_) await_bytes();
}

/// @return bytes of these that still belong to the answer to the request
std::size_t Viewer::end_of_upgrade(std::string_view bytes) {
  const std::size_t before = upgrade_.size();
  upgrade_ += bytes;
  const std::size_t end = upgrade_.find("\r\n\r\n");
  if (end == std::string::npos) return bytes.size();
  if (!upgrade_.starts_with("HTTP/1.1 101")) {
    lose("handshake: " + upgrade_.substr(0, upgrade_.find('\r')));
    return bytes.size();
  }
  upgraded_ = true;
  send(Opcode::text, nlohmann::json{{"op", "view"}, {"codec", plan_.codec}}.dump());
  return end + 4 - before;
}

void Viewer::on_message(Opcode opcode, std::string_view start, std::uint64_t length) {
  switch (opcode) {
    case Opcode::binary:
      return on_frame(start, length);
    case Opcode::text:
      return on_text(start);
    case Opcode::ping:
      return send(Opcode::pong, start);
    case Opcode::close:
      return lose("closed by the server");
    case Opcode::pong:
      return;
  }
}

void Viewer::on_frame(std::string_view start, std::uint64_t length) {
  const std::span bytes(reinterpret_cast<const std::byte*>(start.data()), start.size());
  if (bytes.size() < proto::kCommonBytes + sizeof(proto::FrameFields)) return;
  const auto header = proto::read_at<proto::BinaryHeader>(bytes, 0);
  if (header.type != proto::BinaryType::frame) return;
  const auto fields = proto::read_at<proto::FrameFields>(bytes, proto::kCommonBytes);
  const proto::Bytes ack = proto::encode_ack(fields.sequence);
  send(Opcode::binary, {reinterpret_cast<const char*>(ack.data()), ack.size()});
  if (on_ready_) std::exchange(on_ready_, nullptr)();
  if (!plan_.counting) return;
  if (arrivals_.frames++ == 0) arrivals_.first = fields.sequence;
  arrivals_.last = fields.sequence;
  arrivals_.bytes += length;
  arrivals_.ages.push_back(static_cast<float>(now() + plan_.offset - fields.server_time));
}

void Viewer::on_text(std::string_view text) {
  if (!on_offset_ || text.find("\"ping\"") == std::string_view::npos) return;
  const double arrived = now();
  const auto reply = nlohmann::json::parse(text);
  const double sent = reply["t"], received = reply["received"], answered = reply["sent"];
  const double round_trip = (arrived - sent) - (answered - received);
  std::exchange(on_offset_, nullptr)(((received - sent) + (answered - arrived)) / 2, round_trip);
}

/// The mask of a client's message may be any; four zeros leave the bytes as they are.
void Viewer::send(Opcode opcode, std::string_view bytes) {
  if (bytes.size() > 125) return lose("write: a message longer than is meant");
  std::string message = {static_cast<char>(0x80 | static_cast<int>(opcode)),
                         static_cast<char>(0x80 | static_cast<int>(bytes.size())),
                         0,
                         0,
                         0,
                         0};
  message += bytes;
  write(message);
}

void Viewer::write(std::string_view bytes) {
  error_code error;
  const std::size_t sent = socket_.write_some(asio::buffer(bytes.data(), bytes.size()), error);
  if (error) return lose("write: " + error.message());
  if (sent < bytes.size()) lose("write: the server does not read");
}

void Viewer::lose(const std::string& reason) {
  if (!std::exchange(lost_, true)) on_lost_(reason);
}

}  // namespace weft::load
