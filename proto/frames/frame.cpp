#include "proto/frames/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace weft::proto {
namespace {

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

/// The walker that looks for numbers that are not finite.
struct Finite {
  bool all = true;

  void required(const Field&, float value) { all = all && std::isfinite(value); }
  template <std::size_t N>
  void required(const Field&, const std::array<float, N>& values) {
    all = all && all_finite(values);
  }
  void required(const Field&, std::uint32_t) {}
  template <Worded Enum>
  void required(const Field&, Enum) {}
  void truth(const Field&, std::uint32_t) {}
  void collider_or_none(const Field&, std::uint32_t) {}
};

template <Described Sample>
bool is_finite(const Sample& sample) {
  Finite finite;
  Sample::describe(finite, sample);
  return finite.all;
}

template <Described Sample>
bool read_samples(std::span<const std::byte> payload, std::vector<Sample>& samples) {
  samples = read_array<Sample>(payload);
  return payload.size() % sizeof(Sample) == 0 &&
         std::all_of(samples.begin(), samples.end(),
                     [](const Sample& sample) { return is_finite(sample); });
}

/// Three finite numbers per vertex.
bool read_vectors(const Section& section, std::uint32_t vertices, std::vector<float>& vectors) {
  if (section.payload.size() != std::size_t{vertices} * sizeof(Vec3f)) return false;
  vectors = read_array<float>(section.payload);
  return all_finite(vectors);
}

bool read_section(const Section& section, std::uint32_t vertices, Frame& frame) {
  if (section.kind == kPositions) return read_vectors(section, vertices, frame.positions);
  bool fits = true;
  visit_arrays(frame, [&](const FramePart& part, auto& vectors) {
    if (part.kind == section.kind) fits = read_vectors(section, vertices, vectors);
  });
  visit_lists(frame, [&](const FramePart& part, auto& samples) {
    if (part.kind == section.kind) fits = read_samples(section.payload, samples);
  });
  return fits;
}

/// What is wrong with the fixed part of a frame; null if nothing is.
const char* fault_of(const BinaryHeader& common, const FrameFields& fields) {
  if (common.codec == 1) return "unknown codec";
  if (fields.tick >= kTickEnd) return "the tick is too large";
  if (!std::isfinite(fields.time) || !std::isfinite(fields.server_time))
    return "a time is not finite";
  const bool key = (common.flags & kFrameKey) != 0;
  if (common.codec == 0 && (fields.step != 0 || fields.reference != fields.sequence || !key))
    return "a float32 frame builds on no other";
  if (common.codec == 0) return nullptr;
  if (!std::isfinite(fields.step) || fields.step <= 0) return "the step is not above 0";
  return key == (fields.reference == fields.sequence) ? nullptr : "a key frame builds on no other";
}

}  // namespace

void encode_frame(const FrameView& frame, Bytes& out) {
  const FrameHeader& h = frame.header;
  BinaryWriter writer(out, BinaryType::frame, 0, h.flags);
  std::uint32_t sections = 1;
  const auto count = [&](const FramePart&, auto& items) { sections += items.empty() ? 0U : 1U; };
  visit_lists(frame, count);
  visit_arrays(frame, count);
  writer.put(FrameFields{h.tick, h.time, h.server_time, h.sequence, h.reference, h.epoch,
                         static_cast<std::uint32_t>(frame.positions.size() / 3), 0, sections});
  writer.put_section(kPositions, 0, frame.positions);
  const auto put = [&](const FramePart& part, auto& items) {
    if (!items.empty()) writer.put_section(part.kind, 0, items);
  };
  visit_lists(frame, put);
  visit_arrays(frame, put);
  writer.finish();
}

Bytes with_jump(std::span<const std::byte> message) {
  Bytes bytes(message.begin(), message.end());
  bytes[offsetof(BinaryHeader, flags)] |= std::byte{kFrameJump};
  seal(bytes);
  return bytes;
}

Result<Frame> decode_frame(std::span<const std::byte> message) {
  Result<FrameParts> parts = read_frame(message);
  if (!parts) return std::move(parts).error();
  if (parts->codec != 0) return binary_error("unknown codec");
  return std::move(parts->frame);
}

Result<FrameParts> read_frame(std::span<const std::byte> message) {
  const Result<BinaryHeader> common =
      read_header(message, BinaryType::frame, kFrameBytes, kPackedCodec);
  if (!common) return common.error();
  const auto fields = read_at<FrameFields>(message, kCommonBytes);
  if (const char* fault = fault_of(*common, fields)) return binary_error(fault);
  Result<std::vector<Section>> sections = read_sections(message, kFrameBytes, fields.sections);
  if (!sections) return std::move(sections).error();
  FrameParts parts;
  parts.codec = common->codec;
  parts.vertices = fields.vertices;
  parts.step = fields.step;
  parts.frame.header = {common->flags,   fields.tick,      fields.time, fields.server_time,
                        fields.sequence, fields.reference, fields.epoch};
  bool positions = false;
  for (const Section& section : *sections) {
    if (section.index != 0) continue;
    if (!read_section(section, fields.vertices, parts.frame))
      return binary_error("a section does not fit the frame");
    if (section.kind == kPackedPositions) parts.packed = section.payload;
    positions = positions || section.kind == (parts.codec == 0 ? kPositions : kPackedPositions);
  }
  if (!positions) return binary_error("the frame has no positions");
  return parts;
}

}  // namespace weft::proto
