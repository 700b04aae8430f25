#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/ranges.h"

// The error of an unacceptable definition.

namespace weft {

/// A definition, parameter or file that cannot be accepted. Thrown only when something is built or
/// a parameter is set, never during a step.
///
/// @field field  path of the offending entry, e.g. "cloth.rows"
/// @field value  the value as given
/// @field limit  allowed values, e.g. "2 to 2048"
/// @field hint   suggested remedy; may be empty
/// @field range   the allowed numbers, where `limit` tells such
/// @field causes  names of other fields of the same fabric that may be at fault in its place, from
///                the one that bears most
struct DefinitionError : std::runtime_error {
  std::string field;
  std::string value;
  std::string limit;
  std::string hint;
  std::optional<Range> range = {};
  std::vector<std::string> causes = {};

  DefinitionError(std::string field_in, std::string value_in, std::string limit_in,
                  std::string hint_in = {})
      : std::runtime_error(field_in + " = " + (value_in.empty() ? "(nothing)" : value_in) +
                           ": allowed is " + limit_in +
                           (hint_in.empty() ? std::string() : " (" + hint_in + ")")),
        field(std::move(field_in)), value(std::move(value_in)), limit(std::move(limit_in)),
        hint(std::move(hint_in)) {}

  /// The same of what the field is called elsewhere.
  DefinitionError renamed(std::string new_field) const {
    DefinitionError other(std::move(new_field), value, limit, hint);
    other.range = range;
    other.causes = causes;
    return other;
  }

  /// The same with the numbers that are allowed, and what else may be at fault.
  DefinitionError with(std::optional<Range> range_in, std::vector<std::string> causes_in = {}) && {
    range = range_in;
    causes = std::move(causes_in);
    return std::move(*this);
  }
};

}  // namespace weft
