#include "server/http_routes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <boost/asio/ip/address.hpp>
#include <boost/beast/http/rfc7230.hpp>

#include "proto/events.h"
#include "server/scene_schema.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;

constexpr const char* kJson = "application/json";
constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kMeshPath = "/api/v1/mesh/";
/// A room that has not turned over for so long does not come back by itself [s].
constexpr double kDeadSeconds = 30;

std::string_view view_of(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

HttpResponse response(const HttpRequest& request, http::status status, const char* content_type,
                      std::string body) {
  HttpResponse out(status, request.version());
  out.set(http::field::server, "weft");
  out.set(http::field::content_type, content_type);
  out.set("X-Content-Type-Options", "nosniff");
  out.keep_alive(request.keep_alive());
  out.content_length(body.size());
  if (request.method() != http::verb::head) out.body() = std::move(body);
  return out;
}

HttpResponse not_found(const HttpRequest& request, const std::string& path) {
  proto::HttpError error;
  error.code = "not_found";
  error.message = "no such path: " + path.substr(0, 80);
  error.hint = "see /api/v1/scenes";
  return error_response(request, http::status::not_found, error);
}

HttpResponse mesh_response(const ServiceContext& context, const HttpRequest& request,
                           const std::string& path) {
  const std::string_view digits = std::string_view(path).substr(std::string_view(kMeshPath).size());
  std::uint64_t hash = 0;
  const auto [end, status] =
      std::from_chars(digits.data(), digits.data() + digits.size(), hash, 16);
  const bool readable =
      digits.size() == 16 && status == std::errc() && end == digits.data() + digits.size();
  const SharedBytes bytes = readable ? context.hub.find_mesh(hash) : SharedBytes();
  if (!bytes) return not_found(request, path);
  HttpResponse out = response(request, http::status::ok, "application/octet-stream",
                              std::string(static_cast<const char*>(bytes.data()), bytes.size()));
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
  const bool known = view_of(request[http::field::if_none_match]) == file->etag;
  HttpResponse out = response(request, known ? http::status::not_modified : http::status::ok,
                              file->content_type.c_str(), known ? std::string() : file->bytes);
  out.set(http::field::etag, file->etag);
  out.set(http::field::cache_control, "no-cache");
  return out;
}

/// Host and port of an address such as "http://127.0.0.1:8080".
std::string_view authority_of(std::string_view origin) {
  const std::size_t start = origin.find("://");
  return start == std::string_view::npos ? std::string_view() : origin.substr(start + 3);
}

/// A browser tells where the page came from. On loopback only the names of this machine are its
/// own, because any other name may have been pointed here by somebody else.
bool origin_allowed(const ServiceContext& context, const HttpRequest& request) {
  const auto field = request.find(http::field::origin);
  if (field == request.end()) return true;  // no browser
  const std::string_view origin = view_of(field->value());
  const auto& allowed = context.options.allowed_origins;
  if (std::find(allowed.begin(), allowed.end(), origin) != allowed.end()) return true;
  const std::string port = ":" + std::to_string(context.port);
  const std::string_view authority = authority_of(origin);
  for (const char* name : {"127.0.0.1", "localhost", "[::1]"})
    if (authority == name + port) return true;
  if (is_loopback(context.options.bind)) return authority == context.options.bind + port;
  return !authority.empty() && authority == view_of(request[http::field::host]);
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

HttpResponse check_upgrade(const ServiceContext& context, const HttpRequest& request) {
  if (path_of(request) != "/ws") return not_found(request, path_of(request));
  proto::HttpError error;
  if (!origin_allowed(context, request)) {
    error.code = "not_allowed";
    error.message = "pages of this origin may not connect";
    error.value = std::string(view_of(request[http::field::origin]).substr(0, 80));
    error.hint = "allow it with --allow-origin";
    return error_response(request, http::status::forbidden, error);
  }
  const auto offered = request[http::field::sec_websocket_protocol];
  if (!http::token_list(offered).exists(proto::kSubprotocol)) {
    error.code = "unknown_protocol";
    error.message = std::string("this server speaks ") + proto::kSubprotocol;
    error.value = std::string(view_of(offered).substr(0, 80));
    error.offered = {proto::kSubprotocol};
    return error_response(request, http::status::bad_request, error);
  }
  const auto viewers = static_cast<std::size_t>(context.options.limits.viewers);
  if (context.hub.viewers() >= viewers || context.stopping) {
    error.code = "busy";
    error.message = "at most " + std::to_string(viewers) + " viewers";
    error.hint = "try again later";
    return error_response(request, http::status::service_unavailable, error);
  }
  return HttpResponse(http::status::switching_protocols, request.version());
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
    const double stalled = context.readiness().stalled;
    if (stalled < kDeadSeconds) return response(request, http::status::ok, kText, "ok");
    return response(request, http::status::service_unavailable, kText,
                    "the room has stood for " + std::to_string(std::lround(stalled)) + " s");
  }
  if (path == "/readyz") {
    const proto::Readiness readiness = context.readiness();
    return response(request, readiness.ready ? http::status::ok : http::status::service_unavailable,
                    kJson, proto::encode_readiness(readiness));
  }
  if (path == "/metrics")
    return response(request, http::status::ok, "text/plain; version=0.0.4; charset=utf-8",
                    context.metrics.text());
  if (path == "/version")
    return response(request, http::status::ok, kJson, proto::encode_version(context.version));
  if (path == "/api/v1/scenes")
    return response(request, http::status::ok, kJson, proto::encode_scenes(context.scenes));
  if (path == kSceneSchemaPath)
    return response(request, http::status::ok, "application/schema+json", scene_schema());
  if (path.starts_with(kMeshPath)) return mesh_response(context, request, path);
  if (path == "/ws") {
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
