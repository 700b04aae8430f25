#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "proto/codec/entropy.h"
#include "proto/codec/token.h"

namespace weft::proto::codec {
namespace {

constexpr std::size_t kMostCodedBytes = 2;  // of one token
constexpr std::size_t kMostRawBytes = 3;    // of one residual
// A state x is divided by a frequency f as it is multiplied by 2^44 / f, rounded up: by less than f
// in 2^44, and x is below 2^19 f, so that the product stays below 2^64 and the quotient is exact.
constexpr unsigned kReciprocalBits = 44;
constexpr std::size_t kWordRoom = 8;  // the raw bits are written a word at a time

void put_byte(Bytes& out, std::uint32_t value) {
  out.push_back(static_cast<std::byte>(value));
}

void put_word(Bytes& out, std::uint32_t value) {
  for (std::uint32_t shift = 0; shift < 32; shift += 8) put_byte(out, (value >> shift) & 255U);
}

}  // namespace

TokenTable normalise(std::span<const std::uint32_t, 64> counts) {
  TokenTable table;
  std::uint64_t total = 0;
  for (const std::uint32_t count : counts) total += count;
  if (total == 0) return table;
  std::uint32_t sum = 0, largest = 0;
  for (std::uint32_t t = 0; t < kTokens; ++t) {
    if (counts[t] == 0) continue;
    const std::uint64_t share = std::uint64_t{kFrequencySum} * counts[t] / total;
    table.frequencies[t] = static_cast<std::uint16_t>(std::max<std::uint64_t>(share, 1));
    table.tokens = t + 1;
    sum += table.frequencies[t];
    if (table.frequencies[t] > table.frequencies[largest]) largest = t;
  }
  // Tokens that were raised to 1 may make the sum too large by up to 57.
  const std::uint32_t excess = sum > kFrequencySum ? sum - kFrequencySum : 0;
  if (table.frequencies[largest] > excess) {
    table.frequencies[largest] =
        static_cast<std::uint16_t>(table.frequencies[largest] + kFrequencySum - sum);
    return table;
  }
  for (std::uint32_t t = 0; sum > kFrequencySum; t = (t + 1) % kTokens) {
    if (table.frequencies[t] < 2) continue;
    --table.frequencies[t];
    --sum;
  }
  return table;
}

std::uint32_t EntropyEncoder::encode(std::span<const std::uint32_t> residuals,
                                     std::span<const Neighbours> neighbours, Bytes& out) {
  assert(residuals.size() == 3 * (neighbours.size() + 1));
  take_tokens(residuals, neighbours);
  put_tables(out);
  code_tokens(out);
  const auto raw = std::as_bytes(std::span(raw_).first(raw_bytes_));
  out.insert(out.end(), raw.begin(), raw.end());
  return raw_bytes_;
}

/// First pass, forwards: contexts, tokens and their counts, and the raw bits.
void EntropyEncoder::take_tokens(std::span<const std::uint32_t> residuals,
                                 std::span<const Neighbours> neighbours) {
  const std::size_t count = neighbours.size();
  tokens_.resize(3 * count);
  raw_.resize(kMostRawBytes * 3 * count + kWordRoom);
  counts_ = {};
  std::uint16_t* next = tokens_.data();
  std::uint64_t held = 0;  // raw bits that do not fill a byte yet
  std::uint32_t held_bits = 0;
  std::size_t written = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t* const plane = residuals.data() + c * (count + 1);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t context = context_of(plane[neighbours[i].a] + plane[neighbours[i].b]);
      const Token token = token_of(plane[i]);
      assert(token.token < kTokens);
      ++counts_[i % 2][context][token.token];
      *next++ = static_cast<std::uint16_t>(context << 6U | token.token);
      if (token.bit_count == 0) continue;
      held |= std::uint64_t{token.bits} << held_bits;
      held_bits += token.bit_count;
      std::memcpy(raw_.data() + written, &held, sizeof held);
      written += held_bits / 8;
      held >>= held_bits / 8 * 8;
      held_bits %= 8;
    }
  }
  raw_bytes_ = static_cast<std::uint32_t>(written + (held_bits > 0 ? 1 : 0));
}

void EntropyEncoder::put_tables(Bytes& out) {
  for (std::size_t context = 0; context < kContexts; ++context) {
    std::array<std::uint32_t, 64> counts = counts_[0][context];
    for (std::size_t t = 0; t < counts.size(); ++t) counts[t] += counts_[1][context][t];
    const TokenTable table = normalise(counts);
    put_byte(out, table.tokens);
    std::uint32_t start = 0;
    for (std::uint32_t t = 0; t < table.tokens; ++t) {
      const std::uint32_t f = table.frequencies[t];
      put_byte(out, f < 128 ? f : (f & 127U) | 128U);
      if (f >= 128) put_byte(out, f >> 7U);
      if (f == 0) continue;
      symbols_[context][t] = {((std::uint64_t{1} << kReciprocalBits) + f - 1) / f, f << 19U, start,
                              kFrequencySum - f};
      start += f;
    }
  }
}

/// Second pass, backwards, as the decoder goes forwards.
void EntropyEncoder::code_tokens(Bytes& out) {
  coded_.resize(kMostCodedBytes * tokens_.size() + 2);
  std::uint8_t* const end = coded_.data() + coded_.size();
  std::uint8_t* front = end;
  std::uint32_t now = kStateLow, next = kStateLow;  // in registers, which they swap at each value
  for (std::size_t j = tokens_.size(); j-- > 0;) {
    const Symbol& symbol = symbols_[tokens_[j] >> 6U][tokens_[j] & 63U];
    std::uint32_t x = now;
    // Whether a byte is due is as good as random, so it is written in any case, and kept if it is.
    const std::uint32_t due = x >= symbol.limit ? 1 : 0;
    front[-1] = static_cast<std::uint8_t>(x);
    front -= due;
    x >>= 8 * due;
    while (x >= symbol.limit) {
      *--front = static_cast<std::uint8_t>(x);
      x >>= 8U;
    }
    const auto quotient = static_cast<std::uint32_t>(x * symbol.reciprocal >> kReciprocalBits);
    now = std::exchange(next, x + symbol.start + quotient * symbol.complement);
  }
  // The last value, number 0, is that of the first state.
  put_word(out, next);
  put_word(out, now);
  const auto coded = std::as_bytes(std::span(front, end));
  out.insert(out.end(), coded.begin(), coded.end());
}

}  // namespace weft::proto::codec
