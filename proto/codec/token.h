#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace weft::proto::codec {

/// A residual as the token that is coded and the low bits that go as they are.
struct Token {
  std::uint32_t token = 0, bits = 0, bit_count = 0;
};

inline Token token_of(std::uint32_t value) {
  if (value < 16) return {value, 0, 0};
  const auto e = static_cast<std::uint32_t>(std::bit_width(value)) - 1;
  return {16 + 2 * (e - 4) + ((value >> (e - 1)) & 1U), value & ((1U << (e - 1)) - 1), e - 1};
}

/// Low bits that follow a token.
inline std::uint32_t bit_count_of(std::uint32_t token) {
  return token < 16 ? 0 : ((token - 16) >> 1U) + 3;
}

inline std::uint32_t value_of(std::uint32_t token, std::uint32_t bits) {
  if (token < 16) return token;
  return ((2U + (token & 1U)) << bit_count_of(token)) | bits;
}

/// Contexts of small sums. Static: a table within the function would be copied at each call.
inline constexpr auto kContextOfSum = [] {
  constexpr std::array<std::size_t, 9> kMost = {0, 1, 2, 4, 8, 16, 40, 100, 250};
  std::array<std::uint8_t, kMost.back() + 1> contexts{};
  for (std::size_t sum = 0, context = 0; sum < contexts.size(); ++sum) {
    while (sum > kMost[context]) ++context;
    contexts[sum] = static_cast<std::uint8_t>(context);
  }
  return contexts;
}();

/// Context of a residual by the sum of those of its neighbours a and b.
inline std::size_t context_of(std::uint32_t around) {
  return around < kContextOfSum.size() ? kContextOfSum[around] : 9;
}

}  // namespace weft::proto::codec
