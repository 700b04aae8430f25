#include "server/scene/scene_json.h"

#include <utility>

#include "proto/messages/field_reader.h"
#include "proto/messages/strict_json.h"

namespace weft::server {

StrictJson read_strict_json(std::string_view text, std::size_t most_bytes) {
  StrictJson result;
  auto parsed = proto::parse_object(text, most_bytes);
  result.good = static_cast<bool>(parsed);
  if (parsed) {
    result.root = *std::move(parsed);
  } else {
    result.field = parsed.error().field;
    result.value = parsed.error().value;
    result.reason = parsed.error().message;
  }
  return result;
}

std::string shown_json(const nlohmann::json& node) {
  return proto::shown_value(node);
}

}  // namespace weft::server
