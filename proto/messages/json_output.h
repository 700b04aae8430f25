#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "proto/messages/command_writer.h"
#include "proto/messages/commands.h"

// Parts that several messages share. Included only by the encoders.

namespace weft::proto {

/// The text of a message. Never throws: bytes that are not UTF-8 are replaced.
inline std::string text_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

template <class Value>
void put_if(nlohmann::ordered_json& out, const char* key, const std::optional<Value>& value) {
  if (value) out[key] = *value;
}

inline void put_id(nlohmann::ordered_json& out, const Id& id) {
  if (const auto* number = std::get_if<std::int64_t>(&id)) {
    out["id"] = *number;
  } else {
    out["id"] = std::get<std::string>(id);
  }
}

/// Adds the fields of a command, or of a part of one.
template <class Described>
void put_fields(nlohmann::ordered_json& out, const Described& part) {
  CommandWriter writer(out);
  Described::describe(writer, part);
}

}  // namespace weft::proto
