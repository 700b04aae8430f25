#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "proto/codec/payload.h"
#include "proto/frames/frame.h"

// Frames in codec `packed`, as messages. README.md sections 6 and 10.

namespace weft::proto::codec {

/// What the fixed part of a packed frame says of its codec.
struct PackedFields {
  std::uint32_t reference = 0;  ///< sequence of the frame that it builds on; its own for a key
  float step = 0;               ///< of the lattice [m]
};

/// Makes a packed frame of a float32 frame, which must be valid, and its packed positions. All
/// other sections are the same.
Bytes pack_frame(std::span<const std::byte> float_frame, const PackedFields& fields,
                 std::span<const std::byte> payload);

/// Decodes the frames of one connection in either codec, in the order in which they were sent.
class FrameDecoder {
 public:
  /// Starts with a mesh; the next packed frame must be a key.
  void begin(CodingOrder order);

  /// Accepts exactly what README.md allows. A frame that is refused changes nothing.
  Result<Frame> decode(std::span<const std::byte> message);

 private:
  struct Held {
    Integers integers;
    std::uint32_t sequence = 0;
    bool there = false;
  };

  Result<Frame> unpack(FrameParts parts);

  CodingOrder order_;
  Lattice lattice_;
  Held last_, before_, next_;
  PayloadDecoder payload_;
};

}  // namespace weft::proto::codec
