#pragma once

#include <memory>
#include <optional>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "server/net/service_context.h"
#include "server/net/shared_body.h"

namespace weft::server {

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using HttpResponse = boost::beast::http::response<SharedBody>;

/// The path of the request's target, without query.
std::string path_of(const HttpRequest& request);

/// Whether the request wants to become a WebSocket connection.
bool wants_upgrade(const HttpRequest& request);

/// Refuses a request for a host that this server does not serve (origin.h), and answers 400 if it
/// names none or several; nothing if the host is accepted. Rewrites a target in absolute form to
/// origin form.
std::optional<HttpResponse> refuse_host(const ServiceContext& context, HttpRequest& request);

/// Reason why this upgrade to a WebSocket is refused; status 101 if it is accepted, and then the
/// room that it leads to.
HttpResponse check_upgrade(const ServiceContext& context, const HttpRequest& request,
                           std::shared_ptr<HostedRoom>& room);

/// The answer to a plain request. HEAD gets no body, only its length.
HttpResponse answer_request(const ServiceContext& context, const HttpRequest& request);

/// An error with a JSON body, proto/README.md section 2.
HttpResponse error_response(const HttpRequest& request, boost::beast::http::status status,
                            const proto::HttpError& error);

}  // namespace weft::server
