#pragma once

#include <optional>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/service_context.h"

namespace weft::server {

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

/// The path of the request's target, without query.
std::string path_of(const HttpRequest& request);

/// Whether the request wants to become a WebSocket connection.
bool wants_upgrade(const HttpRequest& request);

/// Why the host that a request is for is not answered to (origin.h): 400 where it names none, or
/// several; nothing if it is. Brings a target in absolute form into origin form.
std::optional<HttpResponse> refuse_host(const ServiceContext& context, HttpRequest& request);

/// Why this upgrade to a WebSocket is refused; status 101 if it is not.
HttpResponse check_upgrade(const ServiceContext& context, const HttpRequest& request);

/// The answer to a plain request. The body is left out for HEAD, with its length told.
HttpResponse answer_request(const ServiceContext& context, const HttpRequest& request);

/// An error with a JSON body, README.md section 2 of proto.
HttpResponse error_response(const HttpRequest& request, boost::beast::http::status status,
                            const proto::HttpError& error);

}  // namespace weft::server
