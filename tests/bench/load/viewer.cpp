#include "tests/bench/load/viewer.h"

#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>

#include "proto/binary.h"
#include "proto/frames/frame.h"
#include "proto/messages/data.h"

namespace weft::load {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using beast::error_code;

double now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

void Viewer::start(std::function<void()> on_ready,
                   std::function<void(const std::string&)> on_lost) {
  on_ready_ = std::move(on_ready);
  on_lost_ = std::move(on_lost);
  beast::get_lowest_layer(ws_).async_connect(plan_.server, [this](error_code error) {
    if (error) return lose("connect: " + error.message());
    error_code ignored;
    beast::get_lowest_layer(ws_).socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    ws_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(beast::http::field::sec_websocket_protocol, proto::kSubprotocol);
    }));
    ws_.read_message_max(1 << 28);
    ws_.async_handshake(plan_.host, target_, [this](error_code refused) {
      if (refused) return lose("handshake: " + refused.message());
      send(nlohmann::json{{"op", "view"}, {"codec", plan_.codec}}.dump(), false);
      read();
    });
  });
}

void Viewer::ping(std::function<void(double, double)> on_offset) {
  on_offset_ = std::move(on_offset);
  send(nlohmann::json{{"op", "ping"}, {"id", 1}, {"t", now()}}.dump(), false);
}

void Viewer::read() {
  ws_.async_read(incoming_, [this](error_code error, std::size_t) {
    if (error) return lose("read: " + error.message());
    on_message();
    incoming_.consume(incoming_.size());
    if (!stalled_) read();
  });
}

void Viewer::on_message() {
  const auto* const bytes = static_cast<const std::uint8_t*>(incoming_.data().data());
  if (ws_.got_binary()) return on_frame(bytes, incoming_.size());
  on_text({reinterpret_cast<const char*>(bytes), incoming_.size()});
}

void Viewer::on_frame(const std::uint8_t* bytes, std::size_t size) {
  const std::span all(reinterpret_cast<const std::byte*>(bytes), size);
  const auto header = proto::read_at<proto::BinaryHeader>(all, 0);
  if (header.type != proto::BinaryType::frame) return;
  const auto fields = proto::read_at<proto::FrameFields>(all, proto::kCommonBytes);
  const proto::Bytes ack = proto::encode_ack(fields.sequence);
  send({reinterpret_cast<const char*>(ack.data()), ack.size()}, true);
  if (on_ready_) std::exchange(on_ready_, nullptr)();
  if (!plan_.counting) return;
  if (arrivals_.frames++ == 0) arrivals_.first = fields.sequence;
  arrivals_.last = fields.sequence;
  arrivals_.bytes += size;
  arrivals_.ages.push_back(static_cast<float>(now() + plan_.offset - fields.server_time));
}

void Viewer::on_text(const std::string& text) {
  if (!on_offset_ || text.find("\"ping\"") == std::string::npos) return;
  const double arrived = now();
  const auto reply = nlohmann::json::parse(text);
  const double sent = reply["t"], received = reply["received"], answered = reply["sent"];
  const double round_trip = (arrived - sent) - (answered - received);
  std::exchange(on_offset_, nullptr)(((received - sent) + (answered - arrived)) / 2, round_trip);
}

void Viewer::send(std::string bytes, bool binary) {
  waiting_.push_back({std::move(bytes), binary});
  if (!writing_) write_next();
}

void Viewer::write_next() {
  writing_ = true;
  ws_.binary(waiting_.front().binary);
  ws_.async_write(asio::buffer(waiting_.front().bytes), [this](error_code error, std::size_t) {
    writing_ = false;
    if (error) return lose("write: " + error.message());
    waiting_.erase(waiting_.begin());
    if (!waiting_.empty()) write_next();
  });
}

void Viewer::lose(const std::string& reason) {
  if (!std::exchange(lost_, true)) on_lost_(reason);
}

}  // namespace weft::load
