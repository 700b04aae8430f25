#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/binary.h"
#include "proto/codec/order.h"

// Residuals to bytes and back: tokens in ten contexts, coded by rANS with two states, and the low
// bits of large residuals as they are. README.md section 10.

namespace weft::proto::codec {

inline constexpr std::size_t kContexts = 10;
inline constexpr std::uint32_t kTokens = 58;
inline constexpr std::uint32_t kFrequencyBits = 12;
inline constexpr std::uint32_t kFrequencySum = 1U << kFrequencyBits;
/// States lie from here to below 256 times as much, and begin and end here.
inline constexpr std::uint32_t kStateLow = 1U << 23U;

/// Frequencies of the tokens in one context.
struct TokenTable {
  std::array<std::uint16_t, kTokens> frequencies{};
  std::uint32_t tokens = 0;  ///< the highest that occurs and one; 0: the context does not occur
};

/// Frequencies in proportion to counts, at least 1 where a token occurs, together 4096.
TokenTable normalise(std::span<const std::uint32_t, 64> counts);

/// Writes residuals. Keeps its buffers from frame to frame.
class EntropyEncoder {
 public:
  /// Appends tables, states and coded tokens to `out`, then the raw bits.
  /// @param residuals  zigzag, three planes of places and the missing one, below 2^25
  /// @returns the length of the raw bits [bytes]
  std::uint32_t encode(std::span<const std::uint32_t> residuals,
                       std::span<const Neighbours> neighbours, Bytes& out);

 private:
  struct Symbol {
    std::uint64_t reciprocal;
    std::uint32_t limit, start, complement;
  };
  using Counts = std::array<std::array<std::uint32_t, 64>, kContexts>;

  void take_tokens(std::span<const std::uint32_t> residuals,
                   std::span<const Neighbours> neighbours);
  void put_tables(Bytes& out);
  void code_tokens(Bytes& out);

  std::vector<std::uint16_t> tokens_;  // context and token, in order
  std::vector<std::uint8_t> raw_;
  std::vector<std::uint8_t> coded_;  // filled from the end
  /// Of values at even and at odd places: a counter waits for the last time that it was raised.
  std::array<Counts, 2> counts_{};
  std::array<std::array<Symbol, 64>, kContexts> symbols_{};
  std::uint32_t raw_bytes_ = 0;
};

/// Reads residuals; survives any bytes.
class EntropyDecoder {
 public:
  /// @param bytes      what `encode` appended; nothing outside is read
  /// @param raw_bytes  the length of the raw bits at their end
  /// @param residuals  three planes of places and the missing one
  /// @returns whether the bytes were exactly those of as many residuals
  bool decode(std::span<const std::byte> bytes, std::uint32_t raw_bytes,
              std::span<const Neighbours> neighbours, std::span<std::uint32_t> residuals);

 private:
  struct Cursor;

  bool read_tables(std::span<const std::byte> bytes, std::size_t& at);
  bool read_table(std::span<const std::byte> bytes, std::size_t& at, std::size_t context);
  bool decode_plane(Cursor& cursor, std::span<const Neighbours> neighbours,
                    std::uint32_t* residuals) const;

  // Frequency and cumulated frequency of a token, by context.
  struct Slot {
    std::uint16_t frequency, start;
  };
  std::array<std::array<Slot, 64>, kContexts> slots_{};
  std::array<std::array<std::uint8_t, kFrequencySum>, kContexts> token_at_{};
  std::array<bool, kContexts> used_{};
  std::vector<std::uint8_t> buffer_;
};

}  // namespace weft::proto::codec
