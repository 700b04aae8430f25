#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace weft::server {

/// One JSON object read as strictly as a message of the wire (no duplicate key, at most 8 levels,
/// finite numbers, UTF-8), or the reason why it is invalid.
// NOLINTNEXTLINE(bugprone-exception-escape): the library's own move, which its types call safe
struct StrictJson {
  nlohmann::json root;
  bool good = false;
  std::string field, value, reason;  ///< of the error; field and value may be empty
};

/// @param most_bytes  larger texts are refused unread
StrictJson read_strict_json(std::string_view text, std::size_t most_bytes);

/// JSON text of a value for an error: always short.
std::string shown_json(const nlohmann::json& node);

}  // namespace weft::server
