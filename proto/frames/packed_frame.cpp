#include "proto/frames/packed_frame.h"

#include <cassert>
#include <cmath>
#include <utility>

namespace weft::proto::codec {

Bytes pack_frame(std::span<const std::byte> float_frame, const PackedFields& packed,
                 std::span<const std::byte> payload) {
  auto fields = read_at<FrameFields>(float_frame, kCommonBytes);
  const bool key = packed.reference == fields.sequence;
  const auto common = read_at<BinaryHeader>(float_frame, 0);
  const auto flags = static_cast<std::uint8_t>(common.flags & ~kFrameKey);
  fields.reference = packed.reference;
  fields.step = packed.step;
  Bytes out;
  out.reserve(float_frame.size() - 12 * std::size_t{fields.vertices} + padded(payload.size()));
  BinaryWriter writer(out, BinaryType::frame, kPackedCodec,
                      static_cast<std::uint8_t>(flags | (key ? kFrameKey : 0)));
  writer.put(fields);
  const auto sections = read_sections(float_frame, kFrameBytes, fields.sections);
  assert(sections.has_value());
  for (const Section& section : *sections) {
    const bool positions = section.kind == kPositions && section.index == 0;
    writer.put_section(positions ? std::uint16_t{kPackedPositions} : section.kind, section.index,
                       positions ? payload : section.payload);
  }
  writer.finish();
  return out;
}

void FrameDecoder::begin(CodingOrder order) {
  order_ = std::move(order);
  last_.there = before_.there = false;
}

Result<Frame> FrameDecoder::decode(std::span<const std::byte> message) {
  Result<FrameParts> parts = read_frame(message);
  if (!parts) return std::move(parts).error();
  if (parts->codec != kPackedCodec) return std::move(parts->frame);
  return unpack(std::move(*parts));
}

Result<Frame> FrameDecoder::unpack(FrameParts parts) {
  const FrameHeader& header = parts.frame.header;
  const bool key = header.reference == header.sequence;
  if (parts.vertices != order_.size()) return binary_error("the frame does not fit the mesh");
  const Result<PayloadHeader> payload = read_payload_header(parts.packed, key);
  if (!payload) return payload.error();
  References references;
  Lattice lattice = lattice_;
  if (key) {
    lattice = {payload->origin, parts.step, 0};
  } else {
    if (!last_.there || last_.sequence != header.reference)
      return binary_error("the frame builds on one that is not there");
    if (parts.step != lattice_.step) return binary_error("the step changes without a key frame");
    references.last = &last_.integers;
  }
  if (payload->prediction.base == Base::straight) {
    if (!before_.there || before_.sequence != payload->before)
      return binary_error("the frame builds on one that is not there");
    references.before = &before_.integers;
  }
  if (const auto error = payload_.decode(order_, *payload, references, next_.integers))
    return *error;
  parts.frame.positions.resize(3 * std::size_t{order_.size()});
  positions_of(lattice, next_.integers, order_.vertices, parts.frame.positions);
  for (const float x : parts.frame.positions)
    if (!std::isfinite(x)) return binary_error("a coordinate is not finite");
  lattice_ = lattice;
  next_.sequence = header.sequence;
  next_.there = true;
  // A key frame starts anew; the frame before it may lie on another lattice.
  if (key) last_.there = false;
  std::swap(before_, last_);
  std::swap(last_, next_);
  return std::move(parts.frame);
}

}  // namespace weft::proto::codec
