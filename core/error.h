#pragma once

#include <stdexcept>
#include <string>
#include <utility>

// The error of an unacceptable definition.

namespace weft {

/// A definition, parameter or file that cannot be accepted. Thrown only when something is built or
/// a parameter is set, never during a step.
///
/// @field field  path of the offending entry, e.g. "cloth.rows"
/// @field value  the value as given
/// @field limit  allowed values, e.g. "2 to 2048"
/// @field hint   suggested remedy; may be empty
struct DefinitionError : std::runtime_error {
  std::string field;
  std::string value;
  std::string limit;
  std::string hint;

  DefinitionError(std::string field_in, std::string value_in, std::string limit_in,
                  std::string hint_in = {})
      : std::runtime_error(field_in + " = " + (value_in.empty() ? "(nothing)" : value_in) +
                           ": allowed is " + limit_in +
                           (hint_in.empty() ? std::string() : " (" + hint_in + ")")),
        field(std::move(field_in)), value(std::move(value_in)), limit(std::move(limit_in)),
        hint(std::move(hint_in)) {}
};

}  // namespace weft
