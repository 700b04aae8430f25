#include "proto/frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proto/section_kinds.h"

namespace weft::proto {
namespace {

// The fixed part after the common bytes.
struct FrameFields {
  std::uint64_t tick;
  double time, server_time;
  std::uint32_t sequence, reference, epoch, vertices;
  float step;
  std::uint32_t sections;
};
static_assert(sizeof(FrameFields) == 48);
constexpr std::size_t kFrameBytes = kCommonBytes + sizeof(FrameFields);

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

bool is_finite(const GrabSample& grab) {
  return all_finite(grab.held) && all_finite(grab.target) && std::isfinite(grab.force);
}

bool is_finite(const PoseSample& pose) {
  return all_finite(pose.position) && all_finite(pose.rotation);
}

bool read_section(const Section& section, std::uint32_t vertices, Frame& frame) {
  const std::size_t size = section.payload.size();
  switch (section.kind) {
    case kPositions:
      if (size != std::size_t{vertices} * sizeof(Vec3f)) return false;
      frame.positions = read_array<float>(section.payload);
      return all_finite(frame.positions);
    case kGrabs:
      frame.grabs = read_array<GrabSample>(section.payload);
      return size % sizeof(GrabSample) == 0 &&
             std::all_of(frame.grabs.begin(), frame.grabs.end(),
                         [](const GrabSample& grab) { return is_finite(grab); });
    case kApplied:
      frame.applied = read_array<AppliedCommand>(section.payload);
      return size % sizeof(AppliedCommand) == 0;
    case kPoses:
      frame.poses = read_array<PoseSample>(section.payload);
      return size % sizeof(PoseSample) == 0 &&
             std::all_of(frame.poses.begin(), frame.poses.end(),
                         [](const PoseSample& pose) { return is_finite(pose); });
    default:
      return true;
  }
}

}  // namespace

void encode_frame(const FrameView& frame, Bytes& out) {
  const FrameHeader& h = frame.header;
  BinaryWriter writer(out, BinaryType::frame, 0, h.flags);
  const std::uint32_t sections = 1U + (frame.grabs.empty() ? 0 : 1) +
                                 (frame.applied.empty() ? 0 : 1) + (frame.poses.empty() ? 0 : 1);
  writer.put(FrameFields{h.tick, h.time, h.server_time, h.sequence, h.reference, h.epoch,
                         static_cast<std::uint32_t>(frame.positions.size() / 3), 0, sections});
  writer.put_section(kPositions, 0, frame.positions);
  if (!frame.grabs.empty()) writer.put_section(kGrabs, 0, frame.grabs);
  if (!frame.applied.empty()) writer.put_section(kApplied, 0, frame.applied);
  if (!frame.poses.empty()) writer.put_section(kPoses, 0, frame.poses);
  writer.finish();
}

Result<Frame> decode_frame(std::span<const std::byte> message) {
  const Result<BinaryHeader> common = read_header(message, BinaryType::frame, kFrameBytes, 0);
  if (!common) return common.error();
  const auto fields = read_at<FrameFields>(message, kCommonBytes);
  if (fields.tick >= kTickEnd) return binary_error("the tick is too large");
  if (!std::isfinite(fields.time) || !std::isfinite(fields.server_time))
    return binary_error("a time is not finite");
  if (fields.step != 0 || fields.reference != fields.sequence || !(common->flags & kFrameKey))
    return binary_error("a float32 frame builds on no other");
  Result<std::vector<Section>> sections = read_sections(message, kFrameBytes, fields.sections);
  if (!sections) return std::move(sections).error();
  Frame frame;
  frame.header = {common->flags,   fields.tick,      fields.time, fields.server_time,
                  fields.sequence, fields.reference, fields.epoch};
  bool positions = false;
  for (const Section& section : *sections) {
    if (section.index != 0) continue;
    if (!read_section(section, fields.vertices, frame))
      return binary_error("a section does not fit the frame");
    positions = positions || section.kind == kPositions;
  }
  if (!positions) return binary_error("the frame has no positions");
  return frame;
}

}  // namespace weft::proto
