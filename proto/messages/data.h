#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "proto/binary.h"
#include "proto/error.h"
#include "proto/messages/commands.h"

// The binary message `data`, which answers a binary query, and the client's `ack`. README.md
// sections 7 and 8.

namespace weft::proto {

struct DataHeader {
  std::uint64_t tick = 0;
  std::uint32_t transfer = 0;    ///< as in the result
  std::uint32_t components = 3;  ///< values per row, 1 to 16
  bool operator==(const DataHeader&) const = default;
};

struct Data {
  DataHeader header;
  std::variant<std::vector<float>, std::vector<double>> values;  ///< row after row
};

/// The message; the number of values is a multiple of `components`.
Bytes encode_data(const DataHeader& header, std::span<const float> values);
Bytes encode_data(const DataHeader& header, std::span<const double> values);

/// Never reads outside `message`.
Result<Data> decode_data(std::span<const std::byte> message);

/// Size of the message [bytes].
/// @param format  f32 or f64
std::size_t data_message_bytes(QueryFormat format, std::size_t count, std::size_t components);

inline constexpr std::size_t kAckBytes = 8;

/// @param sequence  of the decoded frame
Bytes encode_ack(std::uint32_t sequence);

/// The sequence acknowledged by a client's binary message.
Result<std::uint32_t> decode_ack(std::span<const std::byte> message);

}  // namespace weft::proto
