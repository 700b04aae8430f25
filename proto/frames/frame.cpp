#include "proto/frames/frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proto/frames/section_kinds.h"

namespace weft::proto {
namespace {

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

bool is_finite(const GrabSample& grab) {
  return all_finite(grab.held) && all_finite(grab.target) && std::isfinite(grab.force);
}

bool is_finite(const PoseSample& pose) {
  return all_finite(pose.position) && all_finite(pose.rotation);
}

bool is_finite(const AppliedCommand&) {
  return true;
}

bool is_finite(const ContactSample& c) {
  return all_finite(c.point) && all_finite(c.normal) && all_finite(c.friction) &&
         std::isfinite(c.gap) && std::isfinite(c.normal_force);
}

bool is_finite(const ReactionSample& reaction) {
  return all_finite(reaction.force);
}

bool is_finite(const GripperSample& gripper) {
  return all_finite(gripper.position) && all_finite(gripper.rotation) &&
         all_finite(gripper.reaction) && all_finite(gripper.torque) &&
         std::isfinite(gripper.opening) && std::isfinite(gripper.force);
}

/// Passes each list of samples of a frame to `visit` with the kind of its section, in the order of
/// the sections.
template <class AnyFrame, class Visitor>
void visit_samples(AnyFrame& frame, Visitor&& visit) {
  visit(kGrabs, frame.grabs);
  visit(kApplied, frame.applied);
  visit(kPoses, frame.poses);
  visit(kContacts, frame.contacts);
  visit(kReactions, frame.reactions);
  visit(kGrippers, frame.grippers);
}

template <class Sample>
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
  if (section.kind == kVelocities) return read_vectors(section, vertices, frame.velocities);
  bool fits = true;
  visit_samples(frame, [&](SectionKind kind, auto& samples) {
    if (kind == section.kind) fits = read_samples(section.payload, samples);
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
  std::uint32_t sections = frame.velocities.empty() ? 1 : 2;
  visit_samples(frame, [&](SectionKind, auto& samples) { sections += samples.empty() ? 0U : 1U; });
  writer.put(FrameFields{h.tick, h.time, h.server_time, h.sequence, h.reference, h.epoch,
                         static_cast<std::uint32_t>(frame.positions.size() / 3), 0, sections});
  writer.put_section(kPositions, 0, frame.positions);
  visit_samples(frame, [&](SectionKind kind, auto& samples) {
    if (!samples.empty()) writer.put_section(kind, 0, samples);
  });
  if (!frame.velocities.empty()) writer.put_section(kVelocities, 0, frame.velocities);
  writer.finish();
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
