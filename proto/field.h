#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/ranges.h"

// What messages consist of: commands, answers, and the lists in frames. Each is a struct with
//
//   static constexpr const char* kOp     its word in `op`; a part of a message has kName, the name
//                                        of its type in declarations
//   static void describe(io, self)       names its fields once
//
// and everything else walks that: the reader (command_reader.h) and the writer (command_writer.h).
// A walker `io` has
//
//   required(Field, value)         always there
//   optional(Field, value)         may be absent: a std::optional is empty then, and any other
//                                  value keeps what its struct gives it
//   nullable(Field, value)         of messages of the server: null if the std::optional is empty
//   hash(Field, value)             of messages of the server: 16 hexadecimal digits
//   flag(Field, value, usual)      a bool that is absent if it is `usual`
//   only_if(condition, of, Field, value, required)   a field of `of` alone
//   constant(name, what)           tells this form of an `op` from its others; absent if false
//   usual(value, number)           a default that depends on the fields before
//   hold(value)                    where to hold the cloth
//   scene(Field, name, text)       the name of a scene, or the scene itself
//   excludes(name, others)         if the field is there, the others must not be
//   one_at_least(message)          of the optional fields
//   rule(holds, code, field, message)                what else must hold
//
// Lists and objects are values of these whose elements have `describe` themselves.

namespace weft::proto {

/// What must hold of a value beyond its type and range.
enum class Form : std::uint8_t {
  plain,
  direction,   ///< a vector that is not zero
  rotation,    ///< a quaternion of norm 1
  weights,     ///< barycentric: sum 1
  characters,  ///< text without control characters, `range` of characters
  bytes,       ///< text, `range` of bytes
  secret,      ///< the same, never repeated
  file_name,   ///< the same, without a path
  room_name,   ///< the same, lower-case letters, digits and hyphens (room_name.h)
  color,       ///< text "#rrggbb"
};

/// One field of a message, in the words of the wire.
struct Field {
  const char* name;
  const char* meaning;  ///< a clause for people; may be empty
  Range range = {};     ///< of a number, each component, the length of a text or a list
  const char* unit = "";
  Form form = Form::plain;
};

/// The words of an enumeration, in its order.
template <class Enum>
inline constexpr int kWords = 0;

template <class Value>
concept Worded = std::is_enum_v<Value> && !std::same_as<decltype(kWords<Value>), const int>;

template <Worded Enum>
constexpr const char* name_of(Enum value) {
  return kWords<Enum>[static_cast<std::size_t>(value)];
}

/// A struct with a `describe`.
template <class Value>
concept Described = requires(Value value, int walker) {
  Value::describe(walker, value);
};

}  // namespace weft::proto
