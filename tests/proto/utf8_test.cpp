#include "proto/utf8.h"

#include <string>

#include <catch2/catch.hpp>

using namespace weft::proto;

namespace {

// The encoding as RFC 3629 defines it, one code point at a time.
std::string encode(unsigned code) {
  const auto byte = [](unsigned value) { return static_cast<char>(value); };
  const auto tail = [&](int shift) { return byte(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xC0U | (code >> 6U)), tail(0)};
  if (code < 0x10000) return {byte(0xE0U | (code >> 12U)), tail(6), tail(0)};
  return {byte(0xF0U | (code >> 18U)), tail(12), tail(6), tail(0)};
}

bool is_surrogate(unsigned code) {
  return code >= 0xD800 && code < 0xE000;
}

}  // namespace

TEST_CASE("Exactly the code points of Unicode are UTF-8") {
  for (unsigned code = 0; code < 0x1FFFFF; ++code) {
    const std::string text = encode(code);
    if (is_utf8(text) != (code < 0x110000 && !is_surrogate(code))) FAIL("code point " << code);
  }
}

TEST_CASE("The number of UTF-8 texts of three bytes is that of sequences of code points") {
  // Of one byte there are 128 texts, of two 1920 more, of three 61440 (63488 less the surrogates).
  constexpr long kOne = 128, kTwo = 1920, kThree = 61440;
  long count = 0;
  std::string text(3, '\0');
  for (unsigned bits = 0; bits < 1U << 24U; ++bits) {
    text[0] = static_cast<char>(bits & 255U);
    text[1] = static_cast<char>(bits >> 8U & 255U);
    text[2] = static_cast<char>(bits >> 16U);
    count += is_utf8(text) ? 1 : 0;
  }
  CHECK(count == kOne * kOne * kOne + 2 * kOne * kTwo + kThree);
}

TEST_CASE("Characters are counted and cut as code points") {
  const std::string text = "a\xC3\xA9\xF0\x9F\xA7\xB5z";  // a, e acute, spool of thread, z
  CHECK(character_count(text) == 4);
  CHECK(first_characters(text, 0).empty());
  CHECK(first_characters(text, 2) == "a\xC3\xA9");
  CHECK(first_characters(text, 3) == "a\xC3\xA9\xF0\x9F\xA7\xB5");
  CHECK(first_characters(text, 9) == text);
}

TEST_CASE("Control characters are found and no others") {
  for (unsigned code = 0; code < 0x3000; ++code) {
    const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
    if (has_control_character(encode(code).append("y")) != control) FAIL("code point " << code);
  }
}
