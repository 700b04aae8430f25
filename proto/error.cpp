#include "proto/error.h"

#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "proto/utf8.h"

namespace weft::proto {

const char* name_of(ErrorCode code) {
  static constexpr std::array kNames = {"bad_json",
                                        "bad_utf8",
                                        "duplicate_key",
                                        "too_large",
                                        "not_an_object",
                                        "unknown_op",
                                        "missing_field",
                                        "wrong_type",
                                        "wrong_length",
                                        "not_finite",
                                        "out_of_range",
                                        "unknown_value",
                                        "conflicting_fields",
                                        "unknown_scene",
                                        "unknown_drag",
                                        "unknown_pin",
                                        "unknown_viewer",
                                        "unknown_collider",
                                        "unknown_gripper",
                                        "unknown_room",
                                        "unknown_save",
                                        "room_exists",
                                        "drag_exists",
                                        "held",
                                        "not_paused",
                                        "too_many",
                                        "rate_limited",
                                        "not_allowed",
                                        "not_supported",
                                        "busy",
                                        "stalled",
                                        "interrupted",
                                        "halted",
                                        "too_costly",
                                        "internal",
                                        "bad_binary"};
  static_assert(kNames.size() == static_cast<std::size_t>(ErrorCode::bad_binary) + 1);
  return kNames[static_cast<std::size_t>(code)];
}

Error make_error(ErrorCode code, std::string message, std::string hint) {
  Error error;
  error.code = code;
  error.message = std::move(message);
  error.hint = std::move(hint);
  return error;
}

Error range_error(std::string field, double value, Range range) {
  Error error =
      make_error(ErrorCode::out_of_range, field + " must be from " + number_text(range.minimum) +
                                              " to " + number_text(range.maximum));
  error.field = std::move(field);
  error.value = number_text(value);
  error.limit = Limit{range.minimum, range.maximum, {}, {}};
  return error;
}

Error word_error(std::string field, std::string_view value, std::vector<std::string> allowed) {
  std::string list;
  for (const std::string& word : allowed) list += (list.empty() ? "" : ", ") + word;
  Error error =
      make_error(ErrorCode::unknown_value,
                 allowed.empty() ? field + " must be one of those that are there; there are none"
                                 : field + " must be one of " + list);
  error.field = std::move(field);
  error.value = quoted_value(value);
  if (!allowed.empty()) error.limit = Limit{{}, {}, {}, std::move(allowed)};
  return error;
}

std::string number_text(double value) {
  if (!std::isfinite(value)) return "null";
  std::array<char, 32> buffer;
  char* const first = buffer.data();
  char* const last = first + buffer.size();
  // The shortest form of 100000 is 1e+05, which is hard to read.
  const bool plain = std::abs(value) < 1e15 && value == std::floor(value);
  const auto end = plain ? std::to_chars(first, last, value, std::chars_format::fixed)
                         : std::to_chars(first, last, value);
  return std::string(first, end.ptr);
}

std::string quoted_value(std::string_view text) {
  const std::string_view start = first_characters(text, kMostValueCharacters);
  std::string cut(start);
  if (start.size() < text.size()) cut += "...";
  return nlohmann::json(cut).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace weft::proto
