#include "server/room/refusals.h"

#include <algorithm>
#include <utility>

namespace weft::server {

using proto::ErrorCode;
using proto::make_error;

proto::Error field_error(ErrorCode code, std::string message, const char* field,
                         std::uint32_t value, std::string hint) {
  proto::Error error = make_error(code, std::move(message), std::move(hint));
  error.field = field;
  error.value = std::to_string(value);
  return error;
}

proto::Error too_many(const char* what, std::size_t limit, std::string hint) {
  proto::Error error = make_error(ErrorCode::too_many,
                                  "at most " + std::to_string(limit) + " " + what, std::move(hint));
  proto::Limit bound;
  bound.maximum = static_cast<double>(limit);
  error.limit = bound;
  return error;
}

proto::Error unknown_pin(std::uint32_t pin) {
  return field_error(ErrorCode::unknown_pin, "there is no pin with this id", "pin", pin,
                     "the message pins lists them");
}

proto::Error unknown_drag(std::uint32_t drag, std::string hint) {
  return field_error(ErrorCode::unknown_drag, "this viewer has no drag with this number", "drag",
                     drag, std::move(hint));
}

std::optional<proto::Error> check_scene_name(const std::string& name,
                                             const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return std::nullopt;
  proto::Error error = proto::word_error("scene", name, names);
  error.code = ErrorCode::unknown_scene;
  return error;
}

proto::Error unknown_viewer(proto::ViewerId viewer) {
  return field_error(ErrorCode::unknown_viewer, "no viewer has this number", "viewer", viewer,
                     "the message roster lists the viewers");
}

proto::Error not_paused() {
  return make_error(ErrorCode::not_paused, "the room is running", "send pause first");
}

proto::Error advancing_error() {
  return make_error(ErrorCode::busy, "another viewer's advance is running",
                    "wait for its end, or end it by pause");
}

}  // namespace weft::server
