#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "proto/binary.h"
#include "proto/error.h"
#include "proto/types.h"

// The binary message `frame`: positions of the vertices. README.md section 6.

namespace weft::proto {

inline constexpr std::uint8_t kPackedCodec = 2;  ///< of frames; codec/packed_frame.h reads it

enum FrameFlag : std::uint8_t {
  kFrameKey = 1,   ///< needs no other frame
  kFrameJump = 2,  ///< the state was replaced; do not interpolate to it
  kFramePaused = 4,
  kFrameObserved = 8,  ///< has what `observe` of an `advance` asked for
};

struct FrameHeader {
  std::uint8_t flags = kFrameKey;
  std::uint64_t tick = 0;
  double time = 0;              ///< simulated [s]
  double server_time = 0;       ///< server's clock when the tick was done [s]
  std::uint32_t sequence = 0;   ///< counts the room's frames
  std::uint32_t reference = 0;  ///< sequence of the frame that it needs; its own if none
  std::uint32_t epoch = 0;      ///< of the mesh
  bool operator==(const FrameHeader&) const = default;
};

/// A hand at this tick.
struct GrabSample {
  std::uint32_t id = 0;
  ViewerId viewer = 0;
  Vec3f held{}, target{};  ///< [m]
  float force = 0;         ///< magnitude [N]
  bool operator==(const GrabSample&) const = default;
};
static_assert(sizeof(GrabSample) == 36);

/// How many of a viewer's messages this frame includes.
struct AppliedCommand {
  ViewerId viewer = 0;
  std::uint32_t number = 0;  ///< of the last text message, counted from 1
  bool operator==(const AppliedCommand&) const = default;
};
static_assert(sizeof(AppliedCommand) == 8);

/// A collider whose pose differs from the mesh message.
struct PoseSample {
  std::uint32_t collider = 0;  ///< its index in the list of the text message
  Vec3f position{};            ///< of its pivot [m]
  Quatf rotation{};            ///< about it, relative to the mesh message
  bool operator==(const PoseSample&) const = default;
};
static_assert(sizeof(PoseSample) == 32);

/// A contact of the cloth.
struct ContactSample {
  std::uint32_t collider = 0;  ///< index of the object in the text message; kNoCollider: cloth
  std::uint32_t particle = 0;  ///< the cloth particle with the largest weight
  Vec3f point{}, normal{};     ///< on the mid-surface [m]; unit, out of the other side
  float gap = 0;               ///< from the mid-surface to the other side [m]
  float normal_force = 0;      ///< on the cloth, along the normal [N]
  Vec3f friction{};            ///< on the cloth, tangential [N]
  bool operator==(const ContactSample&) const = default;
};
static_assert(sizeof(ContactSample) == 52);
inline constexpr std::uint32_t kNoCollider = 0xffffffff;

/// The partner of a reaction force.
enum class ReactionOf : std::uint32_t {
  pin = 0,       ///< `id` names the pin; force on the cloth
  collider = 1,  ///< `id` is its index in the text message; force of the cloth on it
};

struct ReactionSample {
  ReactionOf of = ReactionOf::pin;
  std::uint32_t id = 0;
  Vec3f force{};  ///< [N]
  bool operator==(const ReactionSample&) const = default;
};
static_assert(sizeof(ReactionSample) == 20);

/// A gripper at the end of the tick.
struct GripperSample {
  std::uint32_t jaw = 0;       ///< its left jaw's index in the text message; the right one follows
  std::uint32_t gripping = 0;  ///< 1 if it presses something, else 0
  Vec3f position{};            ///< of its middle [m]
  Quatf rotation{};            ///< from its definition
  float opening = 0;           ///< between its jaws [m]
  float force = 0;             ///< most that each jaw presses with [N]
  Vec3f reaction{};            ///< of the cloth on both jaws, mean of the tick [N]
  Vec3f torque{};              ///< the same about its middle [N m]
  bool operator==(const GripperSample&) const = default;
};
static_assert(sizeof(GripperSample) == 68);

/// The input of the encoder; the caller owns the arrays.
struct FrameView {
  FrameHeader header;
  std::span<const float> positions;  ///< three per vertex [m], finite
  std::span<const GrabSample> grabs;
  std::span<const AppliedCommand> applied;
  std::span<const PoseSample> poses;
  std::span<const ContactSample> contacts;
  std::span<const ReactionSample> reactions;
  std::span<const float> velocities = {};  ///< three per vertex [m/s], finite; or none
  std::span<const GripperSample> grippers = {};
};

/// Writes codec f32. `out` keeps its capacity from frame to frame, so a steady stream allocates
/// nothing. Empty sections other than positions are left out.
void encode_frame(const FrameView& frame, Bytes& out);

/// A decoded frame.
struct Frame {
  FrameHeader header;
  std::vector<float> positions;  ///< three per vertex [m]
  std::vector<GrabSample> grabs;
  std::vector<AppliedCommand> applied;
  std::vector<PoseSample> poses;
  std::vector<ContactSample> contacts;
  std::vector<ReactionSample> reactions;
  std::vector<float> velocities;  ///< three per vertex [m/s]; empty if it does not tell them
  std::vector<GripperSample> grippers;
};

/// Accepts exactly what README.md allows of codec f32, with finite positions. Never reads outside
/// `message`.
Result<Frame> decode_frame(std::span<const std::byte> message);

/// The fixed part of a frame after the common header, as it is on the wire.
struct FrameFields {
  std::uint64_t tick;
  double time, server_time;
  std::uint32_t sequence, reference, epoch, vertices;
  float step;
  std::uint32_t sections;
};
static_assert(sizeof(FrameFields) == 48);
inline constexpr std::size_t kFrameBytes = kCommonBytes + sizeof(FrameFields);

/// A frame in either codec, as far as no other frame is needed to read it.
struct FrameParts {
  Frame frame;  ///< with positions in codec f32 only
  std::uint8_t codec = 0;
  std::uint32_t vertices = 0;
  float step = 0;                     ///< of the packed positions' lattice [m], above 0
  std::span<const std::byte> packed;  ///< packed positions, inside the message; not checked
};
Result<FrameParts> read_frame(std::span<const std::byte> message);

}  // namespace weft::proto
