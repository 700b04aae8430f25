#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "proto/error.h"

// Common to all binary messages: the first 16 bytes, the checksum, sections. README.md section 6.

namespace weft::proto {

static_assert(std::endian::native == std::endian::little,
              "the wire is little-endian, copied as is");

using Bytes = std::vector<std::byte>;

enum class BinaryType : std::uint8_t { frame = 1, mesh = 2, data = 3, ack = 4 };
inline constexpr std::uint8_t kBinaryVersion = 1;
inline constexpr std::size_t kCommonBytes = 16;
inline constexpr std::size_t kSectionHeaderBytes = 8;
inline constexpr std::size_t kAlignment = 8;  ///< of payloads, and of the whole message

/// The first bytes of every binary message that a server sends.
struct BinaryHeader {
  BinaryType type = BinaryType::frame;
  std::uint8_t version = kBinaryVersion;
  std::uint8_t codec = 0;
  std::uint8_t flags = 0;
  std::uint32_t length = 0;  ///< of the whole message [bytes]
  std::uint32_t sum_a = 0, sum_b = 0;
};
static_assert(sizeof(BinaryHeader) == kCommonBytes);

struct SectionHeader {
  std::uint16_t kind = 0;
  std::uint16_t index = 0;
  std::uint32_t length = 0;  ///< of the payload without padding [bytes]
};
static_assert(sizeof(SectionHeader) == kSectionHeaderBytes);

/// A section inside a message; the payload points into the message.
struct Section {
  std::uint16_t kind = 0;
  std::uint16_t index = 0;
  std::span<const std::byte> payload;
};

inline constexpr std::size_t padded(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

/// Reads a value at an offset that the caller has checked.
template <class T>
T read_at(std::span<const std::byte> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// Copies a payload whose length the caller has checked to be a multiple of the item's size.
template <class T>
std::vector<T> read_array(std::span<const std::byte> payload) {
  std::vector<T> items(payload.size() / sizeof(T));
  if (!items.empty()) std::memcpy(items.data(), payload.data(), items.size() * sizeof(T));
  return items;
}

/// Appends to a message. Reuses the buffer's capacity.
class BinaryWriter {
 public:
  /// Starts a message, dropping the buffer's content.
  BinaryWriter(Bytes& out, BinaryType type, std::uint8_t codec, std::uint8_t flags);

  template <class T>
  void put(const T& value) {
    append(std::as_bytes(std::span(&value, 1)));
  }

  template <class T>
  void put_section(std::uint16_t kind, std::uint16_t index, std::span<const T> items) {
    put(SectionHeader{kind, index, static_cast<std::uint32_t>(items.size_bytes())});
    append(std::as_bytes(items));
    pad();
  }

  void append(std::span<const std::byte> bytes);
  /// Zero bytes up to the next multiple of kAlignment.
  void pad();
  /// Writes length and checksum; the message is complete.
  void finish();

 private:
  Bytes& out_;
};

/// Writes length and checksum of a message that is complete but for them.
void seal(std::span<std::byte> message);

/// Checks type, version, codec, length and checksum and returns the header.
/// @param least_bytes  the size of this type's fixed part
/// @param last_codec   the highest supported codec
Result<BinaryHeader> read_header(std::span<const std::byte> message, BinaryType type,
                                 std::size_t least_bytes, std::uint8_t last_codec);

/// Ticks stay below 2^53, so that every language can represent them.
inline constexpr std::uint64_t kTickEnd = std::uint64_t{1} << 53U;

/// Walks the sections from `offset` to the end of a message whose header is checked. Refuses a
/// section that reaches beyond the end, padding that is not zero, a repeated pair of kind and
/// index, and surplus bytes.
Result<std::vector<Section>> read_sections(std::span<const std::byte> message, std::size_t offset,
                                           std::uint32_t count);

/// The error for bytes that do not form a message of this kind.
Error binary_error(std::string message);

}  // namespace weft::proto
