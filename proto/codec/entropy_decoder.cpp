#include <algorithm>

#include "proto/codec/entropy.h"
#include "proto/codec/token.h"

namespace weft::proto::codec {
namespace {

constexpr std::size_t kCheckEvery = 64;  // residuals between two looks at the cursors
// A residual takes at most 2 coded and 3 raw bytes, and the last read reaches 8 bytes further.
constexpr std::size_t kPadding = 3 * kCheckEvery + 8;

}  // namespace

/// Where reading stands. Both streams are followed by zeros, so that reading may overshoot a little
/// before that is noticed.
struct EntropyDecoder::Cursor {
  const std::uint8_t* coded;
  const std::uint8_t* coded_end;
  const std::uint8_t* raw;
  std::size_t raw_bit = 0, raw_bits = 0;
  std::uint32_t now = 0, next = 0;  // the states; they take turns
};

bool EntropyDecoder::read_table(std::span<const std::byte> bytes, std::size_t& at,
                                std::size_t context) {
  if (at >= bytes.size()) return false;
  const auto tokens = static_cast<std::uint32_t>(bytes[at++]);
  if (tokens > kTokens) return false;
  used_[context] = tokens > 0;
  std::uint32_t start = 0;
  for (std::uint32_t t = 0; t < tokens; ++t) {
    if (at >= bytes.size()) return false;
    auto f = static_cast<std::uint32_t>(bytes[at++]);
    if (f >= 128) {
      if (at >= bytes.size()) return false;
      f = (f & 127U) | static_cast<std::uint32_t>(bytes[at++]) << 7U;
    }
    if (f > kFrequencySum - start) return false;
    slots_[context][t] = {static_cast<std::uint16_t>(f), static_cast<std::uint16_t>(start)};
    std::fill_n(token_at_[context].begin() + start, f, static_cast<std::uint8_t>(t));
    start += f;
  }
  return tokens == 0 || start == kFrequencySum;
}

bool EntropyDecoder::read_tables(std::span<const std::byte> bytes, std::size_t& at) {
  for (std::size_t context = 0; context < kContexts; ++context)
    if (!read_table(bytes, at, context)) return false;
  return true;
}

bool EntropyDecoder::decode(std::span<const std::byte> bytes, std::uint32_t raw_bytes,
                            std::span<const Neighbours> neighbours,
                            std::span<std::uint32_t> residuals) {
  if (raw_bytes > bytes.size()) return false;
  const std::size_t coded_end = bytes.size() - raw_bytes;
  std::size_t at = 0;
  if (!read_tables(bytes.first(coded_end), at) || coded_end - at < 8) return false;
  Cursor cursor{};
  cursor.now = read_at<std::uint32_t>(bytes, at);
  cursor.next = read_at<std::uint32_t>(bytes, at + 4);
  const auto is_state = [](std::uint32_t x) { return x >= kStateLow && x < 256 * kStateLow; };
  if (!is_state(cursor.now) || !is_state(cursor.next)) return false;
  at += 8;
  const std::size_t coded_bytes = coded_end - at;
  buffer_.assign(coded_bytes + raw_bytes + 2 * kPadding, 0);
  std::uint8_t* const raw = buffer_.data() + coded_bytes + kPadding;
  if (coded_bytes > 0) std::memcpy(buffer_.data(), bytes.data() + at, coded_bytes);
  if (raw_bytes > 0) std::memcpy(raw, bytes.data() + coded_end, raw_bytes);
  cursor.coded = buffer_.data();
  cursor.coded_end = buffer_.data() + coded_bytes;
  cursor.raw = raw;
  cursor.raw_bits = 8 * std::size_t{raw_bytes};
  for (std::size_t c = 0; c < 3; ++c)
    if (!decode_plane(cursor, neighbours, residuals.data() + c * (neighbours.size() + 1)))
      return false;
  // The bits that fill up the last byte are 0, and there is no byte more.
  const std::size_t rest = cursor.raw_bits - cursor.raw_bit;
  const bool raw_ends = rest < 8 && (rest == 0 || raw[raw_bytes - 1] >> (8 - rest) == 0);
  return raw_ends && cursor.coded == cursor.coded_end && cursor.now == kStateLow &&
         cursor.next == kStateLow;
}

bool EntropyDecoder::decode_plane(Cursor& cursor, std::span<const Neighbours> neighbours,
                                  std::uint32_t* residuals) const {
  const std::size_t count = neighbours.size();
  residuals[count] = 0;
  Cursor at = cursor;
  for (std::size_t begin = 0; begin < count; begin += kCheckEvery) {
    const std::size_t end = std::min(count, begin + kCheckEvery);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t context =
          context_of(residuals[neighbours[i].a] + residuals[neighbours[i].b]);
      if (!used_[context]) return false;
      std::uint32_t x = at.now;
      const std::uint32_t slot = x & (kFrequencySum - 1);
      const std::uint32_t token = token_at_[context][slot];
      const Slot& found = slots_[context][token];
      x = found.frequency * (x >> kFrequencyBits) + slot - found.start;
      while (x < kStateLow) x = x << 8U | *at.coded++;
      at.now = at.next;
      at.next = x;
      std::uint32_t value = token;
      if (token >= 16) {
        std::uint64_t word = 0;
        std::memcpy(&word, at.raw + at.raw_bit / 8, sizeof word);
        const std::uint32_t bits = bit_count_of(token);
        value = value_of(token,
                         static_cast<std::uint32_t>(word >> at.raw_bit % 8) & ((1U << bits) - 1));
        at.raw_bit += bits;
      }
      residuals[i] = value;
    }
    if (at.coded > at.coded_end || at.raw_bit > at.raw_bits) return false;
  }
  cursor = at;
  return true;
}

}  // namespace weft::proto::codec
