#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "core/ranges.h"
#include "core/types.h"

// Description of definitions: each definition struct has one function `visit_fields` that names its
// fields with unit, allowed range and meaning. Validation, `--set key=value` and the listing of
// allowed values all walk the same description, so they cannot disagree.

namespace weft {

/// Allowed values and description of a field.
struct FieldInfo {
  const char* name;             ///< as in a key, e.g. "areal_density"
  Range range;                  ///< allowed values (of each component)
  const char* unit;             ///< e.g. "kg/m^2"; may be empty
  const char* meaning;          ///< one clause for people
  const char* words = nullptr;  ///< of a choice: the words for 0, 1, 2 ..., separated by '|'
};

/// A field that takes one of several words, stored as an enumeration that counts from 0.
/// @param words  e.g. "verlet|relaxation"
FieldInfo choice(const char* name, const char* words, const char* meaning);

/// The word for a value of a choice.
std::string choice_word(const FieldInfo& info, int value);

/// Checks a number against its range. Throws DefinitionError if it is not finite or outside.
/// @param path   prefix of the field's name in the error, e.g. "fabric."
void check_field(const std::string& path, const FieldInfo& info, double value);
void check_field(const std::string& path, const FieldInfo& info, int value);
void check_field(const std::string& path, const FieldInfo& info, bool value);
void check_field(const std::string& path, const FieldInfo& info, const Vec3d& value);
template <class Enum>
requires std::is_enum_v<Enum>
void check_field(const std::string& path, const FieldInfo& info, Enum value) {
  check_field(path, info, static_cast<int>(value));
}

/// Parses a value ("0.2", "12", "true", "0,-9.81,0") into a field and checks its range. Throws
/// DefinitionError, with the field unchanged, if the text is invalid.
void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 double& value);
void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 int& value);
void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 bool& value);
void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 Vec3d& value);
/// Index of a word in a choice.
int parse_choice(const std::string& path, const FieldInfo& info, const std::string& text);
template <class Enum>
requires std::is_enum_v<Enum>
void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 Enum& value) {
  value = static_cast<Enum>(parse_choice(path, info, text));
}

/// The allowed values in words, e.g. "0.001 to 10 kg/m^2" or "verlet or relaxation".
std::string allowed_values(const FieldInfo& info);

/// The most similar of some words; empty if none is similar.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

/// A number as short text that parses to the same number.
std::string number_text(double value);

/// A number for people, to so many digits.
std::string rounded_text(double value, int digits = 3);

}  // namespace weft
