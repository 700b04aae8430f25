#pragma once

#include <cstddef>
#include <string_view>

namespace weft::proto {

/// Whether the bytes are well-formed UTF-8 (Unicode 15, table 3-7: no overlong forms, no
/// surrogates, nothing above U+10FFFF).
bool is_utf8(std::string_view text);

/// Number of characters (code points) of well-formed UTF-8.
std::size_t character_count(std::string_view text);

/// The longest prefix of at most `count` characters.
std::string_view first_characters(std::string_view text, std::size_t count);

/// Whether well-formed UTF-8 contains a control character (U+0000 to U+001F, U+007F to U+009F).
bool has_control_character(std::string_view text);

}  // namespace weft::proto
