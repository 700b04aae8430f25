#include "server/net/session.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "proto/messages/data.h"
#include "proto/messages/replies.h"
#include "server/net/buffered_close.h"
#include "server/net/close_codes.h"
#include "server/net/network_output.h"
#include "server/net/rate_limit.h"
#include "server/net/socket_options.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using beast::error_code;

// Text beyond the wire's limit is still read up to here, so that its sender gets the proper error.
constexpr std::size_t kMostReadBytes = 4 * proto::kMostMessageBytes;
constexpr double kAcksPerSecond = 4000;
constexpr double kFlood = 2;  // this many times the limit of messages ends the connection
constexpr double kCloseSeconds = 5, kTokenSeconds = 5;  // to close; for a first message
// Until a wrong token is refused, so that few can be tried. The connection counts meanwhile.
constexpr double kWrongTokenSeconds = 0.5;
constexpr int kMostWrongTokens = 3;  // of a viewer that is in; the last one closes its connection

class Session : public ViewerStream, public std::enable_shared_from_this<Session> {
 public:
  Session(ServiceContext& context, std::shared_ptr<HostedRoom> room, asio::ip::tcp::socket socket,
          UpgradeRequest request, const std::string& early,
          std::shared_ptr<ConnectionCount::Place> place)
      : context_(context), room_(std::move(room)), place_(std::move(place)), ws_(std::move(socket)),
        request_(std::move(request)), messages_(context.options.limits.messages_per_second,
                                                context.options.limits.messages_per_second),
        flood_(kFlood * context.options.limits.messages_per_second,
               kFlood * context.options.limits.messages_per_second),
        acks_(kAcksPerSecond, kAcksPerSecond), watch_(ws_.get_executor()), cut_(ws_.get_executor()),
        viewer_(context.next_viewer++) {
    auto& buffered = ws_.next_layer();
    const auto space = buffered.buffer().prepare(early.size());
    buffered.buffer().commit(asio::buffer_copy(space, asio::buffer(early)));
  }

  void start();

  void write(const Message& message, bool more) override;
  void close(std::uint16_t code, const std::string& reason) override;
  void on_welcomed() override {
    pauses_ = false;
    if (refused_) refuse(*std::exchange(refused_, std::nullopt));
    read();
  }

 private:
  Hub& hub() const { return hub_of(*room_); }
  void on_accepted();
  void join(const Grant& grant);
  void await_token();
  void on_first(std::string_view text);
  void read();
  void on_message();
  void on_text(std::string_view text);
  void on_binary();
  void on_request(const proto::Request& request, double received);
  void on_hello(proto::Request request);
  void put(const proto::Request& request, const std::optional<Grant>& grant = {});
  void on_view(const proto::Request& request, const proto::View& view);
  void choose_codec(const proto::View& view);
  void on_excess(std::string_view text);
  void refuse(const proto::Error& error);
  void answer(const std::optional<proto::Id>& id, const proto::Reply& reply);
  void note();
  void watch();
  void close_by_policy(std::uint16_t code, const std::string& reason);
  void cut_later();
  void finish();

  ServiceContext& context_;
  std::shared_ptr<HostedRoom> room_;
  std::shared_ptr<ConnectionCount::Place> place_;
  websocket::stream<beast::buffered_read_stream<beast::tcp_stream, beast::flat_buffer>, false> ws_;
  UpgradeRequest request_;
  beast::flat_buffer incoming_;
  Message outgoing_;
  RateLimit messages_, flood_, acks_;
  asio::steady_timer watch_, cut_;
  proto::ViewerId viewer_;
  ViewerChannel* channel_ = nullptr;     // of the hub; null before joining and after leaving
  std::uint32_t number_ = 0;             // of the last text message
  std::optional<proto::Error> refused_;  // its first message, though it is let in
  int wrong_tokens_ = 0;
  double most_error_ = proto::kUsualPackedError;  // that it allows, if packed [m]
  double alive_ = 0;
  LastSegment last_segment_;
  bool pinging_ = false, finished_ = false, cutting_ = false;
  bool awaits_token_ = false;  // the viewer has not joined
  bool pauses_ = false;        // nothing more is read until the viewer is welcomed
};

void Session::start() {
  error_code ignored;
  auto& socket = beast::get_lowest_layer(ws_).socket();
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  keep_backlog_small(socket);
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = duration_of(context_.options.limits.handshake_seconds);
  timeout.idle_timeout = websocket::stream_base::none();
  timeout.keep_alive_pings = false;
  ws_.set_option(timeout);
  ws_.auto_fragment(false);
  ws_.read_message_max(kMostReadBytes);
  ws_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    response.set(beast::http::field::sec_websocket_protocol, proto::kSubprotocol);
    response.set(beast::http::field::server, "weft");
  }));
  ws_.async_accept(request_, [self = shared_from_this()](error_code error) {
    if (!error) self->on_accepted();
  });
}

void Session::on_accepted() {
  if (context_.stopping) return;
  if (room_->closed()) return close(kCloseRoomClosed, "the room is closed");
  channel_ = &hub().add(viewer_, *this);
  ++context_.viewers;
  alive_ = context_.clock();
  ws_.control_callback(
      [this](websocket::frame_type, beast::string_view) { alive_ = context_.clock(); });
  if (context_.tokens.required()) return await_token();
  join({});
}

/// The viewer's own messages are read from its welcome on.
void Session::join(const Grant& grant) {
  const std::string_view target(request_.target().data(), request_.target().size());
  const auto asks = [target](const char* what) { return target.find(what) != target.npos; };
  pauses_ = true;
  room_->put({viewer_, 0, Join{asks("mesh=http"), grant, asks("glance=1")}});
  watch();
}

void Session::await_token() {
  awaits_token_ = true;
  watch_.expires_after(duration_of(kTokenSeconds));
  watch_.async_wait([self = shared_from_this()](error_code error) {
    if (!error && self->awaits_token_)
      self->close_by_policy(kCloseNoPong, "no token came in time");  // and may come again
  });
  read();
}

/// The first message, where a token is needed: it has to be a `hello` with one that is known. What
/// else is wrong in it is refused after the welcome.
void Session::on_first(std::string_view text) {
  ++number_;
  auto request = proto::parse_request(text);
  const auto token = proto::find_token(text);
  const auto grant = token ? context_.tokens.find(*token, room_->name()) : std::optional<Grant>();
  if (grant) {
    awaits_token_ = false;
    join(*grant);
    if (!request) refused_ = request.error();
    if (!request) return;
    std::get<proto::Hello>(request->command).token.reset();
    return put(*request);
  }
  const proto::Error refusal =
      request ? unknown_token(true, proto::name_of(request->command), request->id)
              : unknown_token(true, request.error().command, request.error().id);
  const char* const why = token ? "this token is not known" : "a token is needed";
  pauses_ = true;
  watch_.expires_after(duration_of(kWrongTokenSeconds));
  watch_.async_wait([self = shared_from_this(), refusal, why](error_code error) {
    if (error) return;
    self->refuse(refusal);
    self->close_by_policy(kCloseToken, why);
  });
}

void Session::read() {
  ws_.async_read(incoming_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->finish();
    self->on_message();
    self->incoming_.consume(self->incoming_.size());
    if (!self->pauses_) self->read();
  });
}

void Session::on_message() {
  alive_ = context_.clock();
  if (!channel_ || channel_->closing()) return;
  if (ws_.got_binary()) return on_binary();
  on_text({static_cast<const char*>(incoming_.data().data()), incoming_.size()});
}

void Session::on_binary() {
  const std::span<const std::byte> bytes(static_cast<const std::byte*>(incoming_.data().data()),
                                         incoming_.size());
  const auto sequence = proto::decode_ack(bytes);
  if (!sequence) return close_by_policy(kCloseNotAnAck, "a binary message that is not an ack");
  if (!acks_.take(context_.clock())) return close_by_policy(kClosePolicy, "too many acks");
  channel_->on_acknowledged(*sequence);
}

void Session::on_text(std::string_view text) {
  if (awaits_token_) return on_first(text);
  const double received = context_.clock();
  ++number_;
  if (!flood_.take(received))
    return close_by_policy(kClosePolicy, "far too many messages a second");
  if (!messages_.take(received)) return on_excess(text);
  const auto request = proto::parse_request(text);
  return request ? on_request(*request, received) : refuse(request.error());
}

void Session::on_request(const proto::Request& request, double received) {
  if (const auto* ping = std::get_if<proto::Ping>(&request.command)) {
    room_->metrics().count_command("ping");
    answer(request.id, proto::PingReply{ping->t, received, context_.clock()});
    return note();
  }
  if (const auto* view = std::get_if<proto::View>(&request.command)) {
    room_->metrics().count_command("view");
    return on_view(request, *view);
  }
  if (std::holds_alternative<proto::Hello>(request.command)) return on_hello(request);
  put(request);
}

/// Takes the token out of a `hello`, because nothing behind the session needs to know it.
void Session::on_hello(proto::Request request) {
  auto& hello = std::get<proto::Hello>(request.command);
  std::optional<Grant> grant;
  if (const auto token = std::exchange(hello.token, std::nullopt)) {
    grant = context_.tokens.find(*token, room_->name());
    if (!grant && context_.tokens.required()) {
      refuse(unknown_token(false, proto::Hello::kOp, request.id));
      if (++wrong_tokens_ < kMostWrongTokens) return;
      return close_by_policy(kCloseToken, "too many tokens that are not known");
    }
  }
  put(request, grant);
}

/// @param grant  of the token that it tells, if it does; goes before it
void Session::put(const proto::Request& request, const std::optional<Grant>& grant) {
  const bool fits = !grant || room_->put({viewer_, number_, *grant});
  if (fits && room_->put({viewer_, number_, request})) return;
  proto::Error error = proto::make_error(proto::ErrorCode::busy, "too many commands are waiting",
                                         "wait for answers before sending more");
  error.command = proto::name_of(request.command);
  error.id = request.id;
  refuse(error);
}

void Session::on_view(const proto::Request& request, const proto::View& view) {
  if (!channel_) return;
  if (auto error = check_right(request.command, hub().role(viewer_), false)) {
    error->command = "view";
    error->id = request.id;
    return refuse(*error);
  }
  const bool had_frames = channel_->wants_frames(), had_forces = channel_->wants_forces();
  if (view.hz) hub().set_most_frames(viewer_, *view.hz);
  if (view.forces) hub().want_forces(viewer_, *view.forces);
  choose_codec(view);
  const double error = channel_->packed_error();
  answer(request.id, proto::ViewReply{channel_->most_frames(),
                                      error > 0 ? proto::Codec::packed : proto::Codec::f32,
                                      channel_->asked_forces(), error});
  // Anything not sent before is missing now, such as a key; no other wish of a viewer makes a
  // frame.
  Noted noted;
  noted.wants_frame = (channel_->wants_frames() && !had_frames) ||
                      (channel_->wants_forces() && !had_forces) ||
                      (channel_->wants_frames() && view.codec == proto::Codec::packed);
  noted.forces = view.forces;
  room_->put({viewer_, number_, noted});
}

void Session::choose_codec(const proto::View& view) {
  most_error_ = view.error.value_or(most_error_);
  double usual = proto::kPackedErrors.front();
  for (const double error : proto::kPackedErrors)
    if (error <= std::min(most_error_, proto::kUsualPackedError)) usual = error;
  const bool packed =
      view.codec ? *view.codec == proto::Codec::packed : channel_->packed_error() > 0;
  if (view.codec || (view.error && packed))
    hub().want_packed(viewer_, packed ? usual : 0, packed ? std::max(usual, most_error_) : 0);
}

/// A dropped message gets an answer too: its sender may wait for one.
void Session::on_excess(std::string_view text) {
  proto::Error error = proto::make_error(proto::ErrorCode::rate_limited,
                                         "too many messages a second; this one was dropped",
                                         "wait for answers, or send less often");
  error.id = proto::find_id(text);
  error.limit = proto::Limit{};
  error.limit->maximum = context_.options.limits.messages_per_second;
  refuse(error);
}

void Session::refuse(const proto::Error& error) {
  room_->metrics().count_error(proto::name_of(error.code));
  if (channel_) channel_->send(text_message(proto::encode_error(error)));
  note();
}

void Session::answer(const std::optional<proto::Id>& id, const proto::Reply& reply) {
  if (id && channel_) channel_->send(text_message(proto::encode_reply(*id, reply)));
}

void Session::note() {
  room_->put({viewer_, number_, Noted{}});
}

void Session::write(const Message& message, bool more) {
  if (message.topic == Topic::frame) acks_.allow_one();  // one ack per frame
  if (more) last_segment_.keep(beast::get_lowest_layer(ws_).socket(), true);
  outgoing_ = message;
  ws_.binary(message.binary);
  ws_.async_write(asio::buffer(message.bytes.data(), message.bytes.size()),
                  [self = shared_from_this()](error_code error, std::size_t bytes) {
                    self->room_->metrics().count_bytes(bytes);
                    self->outgoing_ = {};
                    // Reading notices the broken connection too, and finishes.
                    if (!error && self->channel_) self->channel_->on_written();
                    if (!self->outgoing_.bytes)
                      self->last_segment_.keep(beast::get_lowest_layer(self->ws_).socket(), false);
                  });
}

void Session::close(std::uint16_t code, const std::string& reason) {
  cut_later();
  websocket::close_reason why(static_cast<websocket::close_code>(code));
  why.reason.assign(reason.data(), std::min(reason.size(), why.reason.max_size()));
  ws_.async_close(why, [self = shared_from_this()](error_code) { self->finish(); });
}

void Session::close_by_policy(std::uint16_t code, const std::string& reason) {
  cut_later();
  if (channel_) channel_->close(code, reason);
}

void Session::cut_later() {
  if (std::exchange(cutting_, true)) return;
  cut_.expires_after(duration_of(kCloseSeconds));
  cut_.async_wait([self = shared_from_this()](error_code error) {
    if (!error) self->finish();
  });
}

/// A viewer that sends is alive; one that does not take the end of what it is sent, such as that of
/// its closed room, is cut off all the same.
void Session::watch() {
  const double patience = context_.options.limits.pong_seconds;
  watch_.expires_after(duration_of(patience / 2));
  watch_.async_wait([self = shared_from_this(), patience](error_code error) {
    if (error || !self->channel_) return;
    if (self->channel_->closing()) return self->cut_later();
    if (self->context_.clock() - self->alive_ > patience)
      return self->close_by_policy(kCloseNoPong, "no answer to pings");
    if (!std::exchange(self->pinging_, true))
      self->ws_.async_ping({}, [self](error_code) { self->pinging_ = false; });
    self->watch();
  });
}

void Session::finish() {
  if (std::exchange(finished_, true)) return;
  watch_.cancel();
  cut_.cancel();
  beast::get_lowest_layer(ws_).close();
  if (!std::exchange(channel_, nullptr)) return;
  --context_.viewers;
  hub().remove(viewer_);
  room_->put({viewer_, number_, Leave{}});
}

}  // namespace

void start_session(ServiceContext& context, std::shared_ptr<HostedRoom> room,
                   asio::ip::tcp::socket socket, UpgradeRequest request, const std::string& early,
                   std::shared_ptr<ConnectionCount::Place> place) {
  std::make_shared<Session>(context, std::move(room), std::move(socket), std::move(request), early,
                            std::move(place))
      ->start();
}

}  // namespace weft::server
