#include "server/room/rights.h"

#include <utility>

namespace weft::server {
namespace {

proto::Error not_allowed(const proto::Command& command, std::string message,
                         std::vector<std::string> allowed, std::string hint) {
  proto::Error error =
      proto::make_error(proto::ErrorCode::not_allowed, std::move(message), std::move(hint));
  error.field = "op";
  error.value = proto::quoted_value(proto::name_of(command));
  error.limit = proto::Limit{{}, {}, {}, std::move(allowed)};
  return error;
}

}  // namespace

Grant grant_in(Grant grant, std::string_view room) {
  if (grant.room.empty() || grant.room == room) return grant;
  grant.role = proto::Role::viewer;
  if (grant.hand == HandRight::given) grant.hand = HandRight::by_policy;
  return grant;
}

bool may_hold(HandRight hand, proto::Policy policy, bool leads) {
  if (hand == HandRight::by_policy) return leads || policy != proto::Policy::watch;
  return hand == HandRight::given;
}

std::uint32_t most_hands(proto::Policy policy, std::uint32_t usual) {
  return policy == proto::Policy::one_hand ? 1 : usual;
}

std::optional<proto::Error> check_right(const proto::Command& command, proto::Role role,
                                        bool holds) {
  switch (proto::right_to(command)) {
    case proto::Right::look:
      return std::nullopt;
    case proto::Right::hold:
      if (holds) return std::nullopt;
      return not_allowed(command, "this viewer may only look", {"hand"},
                         "an operator gives hands with give_hand, or changes the policy");
    case proto::Right::operate:
      if (role != proto::Role::viewer) return std::nullopt;
      return not_allowed(
          command, "only operators may do this",
          {proto::name_of(proto::Role::operator_), proto::name_of(proto::Role::admin)},
          "connect with the token of an operator");
  }
  return std::nullopt;
}

}  // namespace weft::server
