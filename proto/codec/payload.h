#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "proto/binary.h"
#include "proto/codec/entropy.h"
#include "proto/codec/lattice.h"
#include "proto/codec/order.h"
#include "proto/codec/prediction.h"
#include "proto/error.h"

// The section `packed positions` of a frame: whole numbers, predicted and coded. README.md section
// 10.

namespace weft::proto::codec {

/// How a payload is to be predicted.
struct PackRequest {
  References references;
  std::uint32_t before = 0;              ///< sequence of `references.before`
  std::optional<Prediction> prediction;  ///< the best, if absent
};

/// Packs frames. Keeps its buffers.
class PayloadEncoder {
 public:
  /// Without `references.last` the payload is a key, which needs no other frame.
  Bytes encode(const CodingOrder& order, const Lattice& lattice, const Integers& now,
               const PackRequest& request);

 private:
  EntropyEncoder entropy_;
  std::vector<std::uint32_t> differences_, residuals_;
};

/// What precedes the coded tokens.
struct PayloadHeader {
  Prediction prediction;
  std::uint32_t before = 0;     ///< sequence of the frame before the reference; 0 if it takes none
  std::uint32_t raw_bytes = 0;  ///< length of the raw bits at the end
  Sums sums;
  std::array<double, 3> origin{};  ///< of a key
  std::span<const std::byte> coded;
};

/// Reads and checks what precedes the tokens.
Result<PayloadHeader> read_payload_header(std::span<const std::byte> payload, bool key);

/// Unpacks frames; survives any bytes. Keeps its buffers.
class PayloadDecoder {
 public:
  /// @param references  those that the header names, of as many vertices as the order
  /// @param out         the frame's numbers; worthless after an error
  std::optional<Error> decode(const CodingOrder& order, const PayloadHeader& header,
                              const References& references, Integers& out);

 private:
  EntropyDecoder entropy_;
  std::vector<std::uint32_t> differences_, residuals_;
};

}  // namespace weft::proto::codec
