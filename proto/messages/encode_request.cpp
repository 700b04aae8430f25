// Commands as JSON.

#include <string>
#include <variant>

#include <nlohmann/json.hpp>

#include "proto/messages/commands.h"
#include "proto/messages/json_output.h"

namespace weft::proto {

std::string encode_request(const Request& request) {
  nlohmann::ordered_json out;
  out["op"] = name_of(request.command);
  if (request.id) put_id(out, *request.id);
  std::visit([&out](const auto& form) { put_fields(out, form); }, request.command);
  return text_of(out);
}

}  // namespace weft::proto
