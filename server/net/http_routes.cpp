#include "server/net/http_routes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include <boost/beast/http/rfc7230.hpp>

#include "proto/messages/events.h"
#include "proto/room_name.h"
#include "server/net/network_output.h"
#include "server/origin.h"
#include "server/scene/scene_schema.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;

constexpr const char* kJson = "application/json";
constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kMeshPath = "/api/v1/mesh/";
/// A room that has made no turn for this long does not recover by itself [s].
constexpr double kDeadSeconds = 30;
constexpr const char* kSocketPath = "/ws";
constexpr const char* kConnectPath = "/api/v1/connect";
constexpr std::size_t kToldBytes = 80;  // of the request's text, in an error

std::string_view view_of(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

HttpResponse response(const HttpRequest& request, http::status status, const char* content_type,
                      SharedBytes body) {
  HttpResponse out(status, request.version());
  out.set(http::field::server, "weft");
  out.set(http::field::content_type, content_type);
  out.set("X-Content-Type-Options", "nosniff");
  out.set("Referrer-Policy", "same-origin");
  out.keep_alive(request.keep_alive());
  out.content_length(body.size());
  if (request.method() != http::verb::head) out.body() = std::move(body);
  return out;
}

HttpResponse response(const HttpRequest& request, http::status status, const char* content_type,
                      std::string body) {
  return response(request, status, content_type, SharedBytes(std::move(body)));
}

HttpResponse not_found(const HttpRequest& request, const std::string& path) {
  proto::HttpError error;
  error.code = "not_found";
  error.message = "no such path: " + path.substr(0, 80);
  error.hint = "see /api/v1/scenes";
  return error_response(request, http::status::not_found, error);
}

HttpResponse no_room(const HttpRequest& request, const std::string& name) {
  proto::HttpError error;
  error.code = "unknown_room";
  error.message = "there is no such room";
  error.value = name.substr(0, kToldBytes);
  error.hint = "see /api/v1/rooms; create_room opens one";
  return error_response(request, http::status::not_found, error);
}

/// The room of a socket's address; nothing if the path is none.
std::optional<std::string> room_of(const std::string& path) {
  if (path == kSocketPath) return proto::kDefaultRoom;
  const std::string folder = std::string(kSocketPath) + "/";
  if (!path.starts_with(folder)) return std::nullopt;
  return path.substr(folder.size());
}

HttpResponse mesh_response(const ServiceContext& context, const HttpRequest& request,
                           const std::string& path) {
  const std::string_view digits = std::string_view(path).substr(std::string_view(kMeshPath).size());
  std::uint64_t hash = 0;
  const auto [end, status] =
      std::from_chars(digits.data(), digits.data() + digits.size(), hash, 16);
  const bool readable =
      digits.size() == 16 && status == std::errc() && end == digits.data() + digits.size();
  SharedBytes bytes;
  for (const auto& room : readable ? context.rooms.all() : decltype(context.rooms.all())()) {
    bytes = hub_of(*room).find_mesh(hash);
    if (bytes) break;
  }
  if (!bytes) return not_found(request, path);
  HttpResponse out =
      response(request, http::status::ok, "application/octet-stream", std::move(bytes));
  out.set(http::field::cache_control, "public, max-age=31536000, immutable");
  return out;
}

HttpResponse file_response(const ServiceContext& context, const HttpRequest& request,
                           const std::string& path) {
  const StaticFile* file = context.files.find(path);
  if (!file && path == "/") {
    proto::HttpError error;
    error.code = "not_found";
    error.message = "this server was started without the page";
    error.hint = "build the page or name its directory with --web; the socket works without it";
    return error_response(request, http::status::not_found, error);
  }
  if (!file) return not_found(request, path);
  const FileContent& content = file->content_for(view_of(request[http::field::accept_encoding]));
  const bool known = view_of(request[http::field::if_none_match]) == content.etag;
  HttpResponse out = response(request, known ? http::status::not_modified : http::status::ok,
                              file->content_type.c_str(), known ? std::string() : content.bytes);
  out.set(http::field::etag, content.etag);
  out.set(http::field::vary, "Accept-Encoding");
  if (!content.encoding.empty()) out.set(http::field::content_encoding, content.encoding);
  out.set(http::field::cache_control, "no-cache");
  return out;
}

OriginRules rules_of(const ServiceContext& context) {
  return {context.options.allowed_origins, context.port};
}

HttpResponse bad_request(const HttpRequest& request, const char* message, std::string_view value) {
  proto::HttpError error;
  error.code = "bad_request";
  error.message = message;
  error.value = std::string(value.substr(0, kToldBytes));
  return error_response(request, http::status::bad_request, error);
}

HttpResponse foreign_host(const HttpRequest& request, const OriginRules& rules,
                          const std::string& host) {
  proto::HttpError error;
  error.code = "not_allowed";
  error.message = "this server does not answer to the name " + host.substr(0, kToldBytes);
  error.value = host.substr(0, kToldBytes);
  error.offered = rules.allowed_hosts();
  error.offered.emplace_back("any IP address");
  error.hint = "open one of those, or start the server with --allow-origin http://" +
               host.substr(0, kToldBytes) + " (https:// behind a proxy with TLS)";
  return error_response(request, http::status::forbidden, error);
}

/// Rewrites the target `http://host/path` to `/path`, and puts its host in place of the Host field
/// (RFC 9112 section 3.2.2). Other forms of target stay.
/// @return false if its host is invalid
bool take_absolute_target(HttpRequest& request) {
  const std::string target(request.target());
  const std::size_t slashes = target.find("://");
  if (target.starts_with('/') || slashes == std::string::npos) return true;
  const std::size_t path = target.find_first_of("/?", slashes + 3);
  const std::optional<Origin> origin = parse_origin(target.substr(0, path));
  if (!origin || (origin->scheme != "http" && origin->scheme != "https")) return false;
  request.set(http::field::host, target.substr(slashes + 3, path - slashes - 3));
  const std::string rest = path == std::string::npos ? "" : target.substr(path);
  request.target(rest.starts_with('/') ? rest : "/" + rest);
  return true;
}

/// Reason why a page of this origin may not open the socket; status 101 if it may.
HttpResponse check_origin(const ServiceContext& context, const HttpRequest& request,
                          std::string_view origin) {
  const auto host = parse_authority(view_of(request[http::field::host])).value_or(Authority{});
  if (!rules_of(context).origin_allowed(origin, host)) {
    proto::HttpError error;
    error.code = "not_allowed";
    error.message = "pages of " + std::string(origin.substr(0, kToldBytes)) + " may not connect";
    error.value = std::string(origin.substr(0, kToldBytes));
    error.hint = parse_origin(origin) ? "start the server with --allow-origin " + error.value
                                      : "a page from a file or a sandbox has no origin to allow";
    return error_response(request, http::status::forbidden, error);
  }
  return {http::status::switching_protocols, request.version()};
}

/// Reason why no further viewer is admitted; status 101 if one is.
HttpResponse check_capacity(const ServiceContext& context, const HttpRequest& request) {
  const auto viewers = static_cast<std::size_t>(context.options.limits.viewers);
  if (context.viewers >= viewers || context.stopping) {
    proto::HttpError error;
    error.code = "busy";
    error.message =
        context.stopping ? "the server stops" : "at most " + std::to_string(viewers) + " viewers";
    error.hint = "try again later";
    return error_response(request, http::status::service_unavailable, error);
  }
  return {http::status::switching_protocols, request.version()};
}

/// Value of a query such as `origin=`, unescaped: neither an origin nor a room needs escapes.
std::string_view asked(std::string_view target, std::string_view name) {
  for (std::size_t at = target.find('?'); at != std::string_view::npos; at = target.find('&', at)) {
    const std::string_view rest = target.substr(++at);
    if (rest.starts_with(name)) return rest.substr(name.size(), rest.find('&') - name.size());
  }
  return {};
}

/// Tells a page the reason of its refused socket, because browsers hide the answer to an upgrade.
HttpResponse connect_response(const ServiceContext& context, const HttpRequest& request) {
  const std::string_view origin = asked(view_of(request.target()), "origin=");
  if (!origin.empty()) {
    HttpResponse refusal = check_origin(context, request, origin);
    if (refusal.result() != http::status::switching_protocols) return refusal;
  }
  const std::string room(asked(view_of(request.target()), "room="));
  if (!room.empty() && !context.rooms.find(room)) return no_room(request, room);
  HttpResponse refusal = check_capacity(context, request);
  if (refusal.result() != http::status::switching_protocols) return refusal;
  HttpResponse out =
      response(request, http::status::ok, kJson, proto::encode_version(context.version));
  out.set(http::field::cache_control, "no-store");
  return out;
}

}  // namespace

std::string path_of(const HttpRequest& request) {
  const std::string_view target = view_of(request.target());
  return std::string(target.substr(0, target.find('?')));
}

bool wants_upgrade(const HttpRequest& request) {
  return http::token_list(request[http::field::upgrade]).exists("websocket") &&
         http::token_list(request[http::field::connection]).exists("upgrade");
}

HttpResponse error_response(const HttpRequest& request, http::status status,
                            const proto::HttpError& error) {
  HttpResponse out = response(request, status, kJson, proto::encode_http_error(error));
  if (status != http::status::not_found) out.keep_alive(false);
  return out;
}

HttpResponse check_upgrade(const ServiceContext& context, const HttpRequest& request,
                           std::shared_ptr<HostedRoom>& room) {
  const std::optional<std::string> name = room_of(path_of(request));
  if (!name) return not_found(request, path_of(request));
  room = context.rooms.find(*name);
  if (!room) return no_room(request, *name);
  const auto origin = request.find(http::field::origin);
  if (origin != request.end()) {  // sent by a browser
    HttpResponse refusal = check_origin(context, request, view_of(origin->value()));
    if (refusal.result() != http::status::switching_protocols) return refusal;
  }
  const auto offered = request[http::field::sec_websocket_protocol];
  if (!http::token_list(offered).exists(proto::kSubprotocol)) {
    proto::HttpError error;
    error.code = "unknown_protocol";
    error.message = std::string("this server speaks ") + proto::kSubprotocol;
    error.value = std::string(view_of(offered).substr(0, kToldBytes));
    error.offered = {proto::kSubprotocol};
    return error_response(request, http::status::bad_request, error);
  }
  return check_capacity(context, request);
}

std::optional<HttpResponse> refuse_host(const ServiceContext& context, HttpRequest& request) {
  const std::size_t hosts = request.count(http::field::host);
  if (hosts > 1) return bad_request(request, "more than one Host", "");
  if (hosts == 0 && request.version() >= 11) return bad_request(request, "no Host", "");
  if (!take_absolute_target(request))
    return bad_request(request, "the target's host is invalid", view_of(request.target()));
  const auto field = request.find(http::field::host);
  if (field == request.end()) return std::nullopt;  // HTTP/1.0: not a browser
  const std::optional<Authority> host = parse_authority(view_of(field->value()));
  if (!host) return bad_request(request, "Host is invalid", view_of(field->value()));
  const OriginRules rules = rules_of(context);
  if (!rules.host_allowed(*host)) return foreign_host(request, rules, host->host);
  return std::nullopt;
}

HttpResponse answer_request(const ServiceContext& context, const HttpRequest& request) {
  proto::HttpError error;
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    error.code = "not_allowed";
    error.message = "only GET and HEAD are answered";
    HttpResponse out = error_response(request, http::status::method_not_allowed, error);
    out.set(http::field::allow, "GET, HEAD");
    return out;
  }
  const std::string path = path_of(request);
  if (path == "/healthz") {
    const proto::Readiness worst = context.rooms.readiness();
    if (worst.stalled < kDeadSeconds) return response(request, http::status::ok, kText, "ok");
    return response(request, http::status::service_unavailable, kText,
                    "the room " + worst.room + " has made no turn for " +
                        std::to_string(std::lround(worst.stalled)) + " s");
  }
  if (path == "/readyz") {
    const proto::Readiness readiness = context.rooms.readiness();
    return response(request, readiness.ready ? http::status::ok : http::status::service_unavailable,
                    kJson, proto::encode_readiness(readiness));
  }
  if (path == "/metrics")
    return response(request, http::status::ok, "text/plain; version=0.0.4; charset=utf-8",
                    context.rooms.metrics_text());
  if (path == "/version")
    return response(request, http::status::ok, kJson, proto::encode_version(context.version));
  if (path == "/api/v1/scenes")
    return response(request, http::status::ok, kJson, proto::encode_scenes(context.scenes));
  if (path == "/api/v1/rooms") {
    const proto::ListRoomsReply rooms = context.rooms.list();
    return response(request, http::status::ok, kJson, proto::encode_rooms(rooms.rooms, rooms.most));
  }
  if (path == kSceneSchemaPath)
    return response(request, http::status::ok, "application/schema+json", scene_schema());
  if (path == kConnectPath) return connect_response(context, request);
  if (path.starts_with(kMeshPath)) return mesh_response(context, request, path);
  if (room_of(path)) {
    error.code = "upgrade_required";
    error.message = "this is a WebSocket address";
    error.hint = std::string("open it with the subprotocol ") + proto::kSubprotocol;
    HttpResponse out = error_response(request, http::status::upgrade_required, error);
    out.set(http::field::upgrade, "websocket");
    return out;
  }
  return file_response(context, request, path);
}

}  // namespace weft::server
