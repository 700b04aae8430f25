#pragma once

#include <array>
#include <cstdint>

#include "proto/field.h"

// What a viewer may do. Each command tells in its description which right it needs, `kRight`.

namespace weft::proto {

/// By token; each has the rights of those before it.
enum class Role : std::uint8_t { viewer, operator_, admin };
template <>
inline constexpr std::array<const char*, 3> kWords<Role> = {"viewer", "operator", "admin"};

/// What a command needs.
enum class Right : std::uint8_t {
  look,     ///< every viewer has it; such a command changes nothing in the room
  hold,     ///< viewers have it as the policy of the room lets them
  operate,  ///< operators have it
};
template <>
inline constexpr std::array<const char*, 3> kWords<Right> = {"look", "hold", "operate"};

/// A right that only some fields or words of a command need beyond that of the command itself.
struct FurtherRight {
  const char* what;  ///< in words
  Right right;
};

/// The right that this very command needs.
template <class Form>
constexpr Right right_to(const Form& form) {
  if constexpr (requires { form.right(); })
    return form.right();
  else
    return Form::kRight;
}

/// Who may hold the cloth.
enum class Policy : std::uint8_t {
  watch,      ///< only viewers that were given a hand
  one_hand,   ///< each viewer, with one hand
  everybody,  ///< each viewer
};
template <>
inline constexpr std::array<const char*, 3> kWords<Policy> = {"watch", "one_hand", "everybody"};

}  // namespace weft::proto
