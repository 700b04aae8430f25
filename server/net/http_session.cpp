#include "server/net/http_session.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/write.hpp>

#include "server/net/http_routes.h"
#include "server/net/lingering_close.h"
#include "server/net/session.h"
#include "server/net/socket_options.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using beast::error_code;

constexpr std::size_t kMostHeaderBytes = 16 * 1024;
constexpr std::string_view kHeaderEnd = "\r\n\r\n";

/// Reads headers itself and parses them once they are complete, so that no byte that a client sends
/// after its upgrade request is lost.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(ServiceContext& context, asio::ip::tcp::socket socket,
              std::shared_ptr<ConnectionCount::Place> place, bool refuse)
      : context_(context), place_(std::move(place)), stream_(std::move(socket)), refuse_(refuse),
        own_address_(place_->address()) {
    error_code ignored;
    const auto peer = stream_.socket().remote_endpoint(ignored);
    from_proxy_ = !ignored && context_.trusts(peer.address());
    stream_.socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    keep_backlog_small(stream_.socket());  // so that a slow client's pieces are small
  }

  void start() {
    // The first request has a shorter deadline than later ones: a new connection has a request to
    // send.
    expire_after(context_.options.limits.handshake_seconds);
    take_request();
  }

 private:
  void expire_after(double seconds) { stream_.expires_after(duration_of(seconds)); }

  std::string_view received() const {
    return {static_cast<const char*>(buffer_.data().data()), buffer_.size()};
  }

  void take_request() {
    const std::size_t end = received().find(kHeaderEnd);
    if (end != std::string_view::npos) return parse(end + kHeaderEnd.size());
    if (buffer_.size() >= kMostHeaderBytes)
      return refuse(http::status::request_header_fields_too_large, "too_large",
                    "the header is larger than 16 KiB");
    stream_.async_read_some(buffer_.prepare(4096),
                            [self = shared_from_this()](error_code error, std::size_t bytes) {
                              if (error) return;
                              self->buffer_.commit(bytes);
                              self->take_request();
                            });
  }

  void parse(std::size_t header_bytes) {
    http::request_parser<http::empty_body> parser;
    parser.header_limit(static_cast<std::uint32_t>(kMostHeaderBytes));
    // A body of any announced length is refused below, by name. (In Boost 1.74 `none` allows none.)
    parser.body_limit(std::numeric_limits<std::uint64_t>::max());
    error_code error;
    parser.put(asio::buffer(buffer_.data().data(), header_bytes), error);
    const bool has_body =
        parser.is_header_done() && (parser.chunked() || parser.content_length().value_or(0) > 0);
    if (has_body) {
      request_ = parser.get();
      return refuse(http::status::payload_too_large, "too_large", "a request has no body here");
    }
    if (error || !parser.is_done())
      return refuse(http::status::bad_request, "bad_request", "this is not HTTP/1.1");
    buffer_.consume(header_bytes);
    request_ = parser.release();
    respond();
  }

  void respond() {
    if (refuse_ || !count_for_client())
      return refuse(http::status::service_unavailable, "busy", "too many connections");
    if (std::optional<HttpResponse> refusal = refuse_host(context_, request_))
      return write(std::move(*refusal));
    if (!wants_upgrade(request_) || request_.method() != http::verb::get)
      return write(answer_request(context_, request_));
    std::shared_ptr<HostedRoom> room;
    HttpResponse answer = check_upgrade(context_, request_, room);
    if (answer.result() != http::status::switching_protocols) return write(std::move(answer));
    stream_.expires_never();
    start_session(context_, std::move(room), stream_.release_socket(), std::move(request_),
                  std::string(received()), std::move(place_));
  }

  std::vector<std::string> values_of(std::string_view name) const {
    std::vector<std::string> list;
    const auto [first, last] = request_.equal_range({name.data(), name.size()});
    for (auto field = first; field != last; ++field) list.emplace_back(field->value());
    return list;
  }

  /// Counts a connection of a proxy for the client of its request. A client that the proxy does not
  /// tell counts as the proxy itself.
  /// @return false if that client has too many
  bool count_for_client() {
    if (!from_proxy_) return true;
    const ForwardedFields fields{values_of("X-Forwarded-For"), values_of("Forwarded")};
    const auto client = forwarded_client(fields, context_.trusted_proxies);
    const std::string address = client ? counted_as(*client) : own_address_;
    if (address != place_->address()) place_->move_to(address);
    return context_.connections.of_address(address) <=
           context_.options.limits.connections_per_address;
  }

  void refuse(http::status status, const char* code, const char* message) {
    proto::HttpError error;
    error.code = code;
    error.message = message;
    HttpResponse answer = error_response(request_, status, error);
    answer.keep_alive(false);
    write(std::move(answer));
  }

  void write(HttpResponse response) {
    response_ = std::move(response);
    serializer_.emplace(response_);
    if (request_.method() != http::verb::head && response_.result() != http::status::not_modified)
      return write_on();
    // The announced length is that of the omitted body.
    expire_after(context_.options.limits.idle_seconds);
    http::async_write_header(stream_, *serializer_,
                             [self = shared_from_this()](error_code error, std::size_t) {
                               if (!error) self->on_written();
                             });
  }

  /// Writes as much as the connection takes. The deadline is that of each piece: a large mesh may
  /// take a slow client long, and one that takes nothing is cut off.
  void write_on() {
    expire_after(context_.options.limits.idle_seconds);
    http::async_write_some(stream_, *serializer_,
                           [self = shared_from_this()](error_code error, std::size_t) {
                             if (error) return;
                             self->serializer_->is_done() ? self->on_written() : self->write_on();
                           });
  }

  void on_written() {
    const bool stays = response_.keep_alive() && !context_.stopping;
    serializer_.reset();
    response_ = {};  // it may share a large mesh
    if (!stays) return end();
    expire_after(context_.options.limits.idle_seconds);
    take_request();
  }

  // The connection counts until it is closed, so that the limits cover closing ones too.
  void end() {
    async_lingering_close(stream_, [self = shared_from_this()](error_code) {});
  }

  ServiceContext& context_;
  std::shared_ptr<ConnectionCount::Place> place_;
  beast::tcp_stream stream_;
  bool refuse_;
  std::string own_address_;  // that it comes from, as counted
  bool from_proxy_ = false;
  beast::flat_buffer buffer_;
  HttpRequest request_;
  HttpResponse response_;
  std::optional<http::response_serializer<SharedBody>> serializer_;  // of the response
};

}  // namespace

void start_http_session(ServiceContext& context, asio::ip::tcp::socket socket,
                        std::shared_ptr<ConnectionCount::Place> place, bool refuse) {
  std::make_shared<HttpSession>(context, std::move(socket), std::move(place), refuse)->start();
}

}  // namespace weft::server
