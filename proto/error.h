#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "proto/limits.h"
#include "proto/types.h"

namespace weft::proto {

/// Why a message was refused. README.md lists the meanings.
enum class ErrorCode : std::uint8_t {
  bad_json,
  bad_utf8,
  duplicate_key,
  too_large,
  not_an_object,
  unknown_op,
  missing_field,
  wrong_type,
  wrong_length,
  not_finite,
  out_of_range,
  unknown_value,
  conflicting_fields,
  unknown_scene,
  unknown_drag,
  unknown_pin,
  unknown_viewer,
  unknown_collider,
  unknown_gripper,
  unknown_room,
  unknown_save,
  room_exists,
  drag_exists,
  held,
  not_paused,
  too_many,
  rate_limited,
  not_allowed,
  not_supported,
  busy,
  stalled,
  interrupted,
  halted,
  too_costly,
  internal,
  bad_binary,  ///< only from decoders, never on the wire
};

/// The word on the wire, e.g. "out_of_range".
const char* name_of(ErrorCode code);

/// The allowed values. Only applicable members are set.
struct Limit {
  std::optional<double> minimum, maximum;
  std::optional<std::size_t> length;  ///< of an array, in elements
  std::vector<std::string> allowed;   ///< words

  bool operator==(const Limit&) const = default;
};

struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;  ///< one sentence for people
  std::string field;    ///< path such as "target[1]"; empty if no field is concerned
  std::string value;    ///< the sent value, as JSON text; may be empty
  std::optional<Limit> limit;
  std::string hint;      ///< what to do; may be empty
  std::string command;   ///< `op` of the refused command; empty if unknown
  std::optional<Id> id;  ///< of the refused command

  bool operator==(const Error&) const = default;
};

/// Either a value or the error in its place.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

  bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// The value; only if there is one.
  const T& operator*() const& { return *std::get_if<0>(&content_); }
  T& operator*() & { return *std::get_if<0>(&content_); }
  T&& operator*() && { return std::move(*std::get_if<0>(&content_)); }
  const T* operator->() const { return std::get_if<0>(&content_); }
  T* operator->() { return std::get_if<0>(&content_); }

  /// The reason; only if there is no value.
  const Error& error() const& { return *std::get_if<1>(&content_); }
  Error&& error() && { return std::move(*std::get_if<1>(&content_)); }

 private:
  std::variant<T, Error> content_;
};

/// An error that concerns no field.
Error make_error(ErrorCode code, std::string message, std::string hint = {});

/// A number outside its range: names field, value and limit.
Error range_error(std::string field, double value, Range range);

/// A word outside the allowed list.
Error word_error(std::string field, std::string_view value, std::vector<std::string> allowed);

/// A number as short text that reads back to the same number; "null" if it is not finite.
std::string number_text(double value);

/// A string as JSON text, cut to kMostValueCharacters characters.
std::string quoted_value(std::string_view text);

}  // namespace weft::proto
