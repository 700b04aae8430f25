#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "proto/binary.h"
#include "proto/error.h"
#include "proto/types.h"

// The binary message `frame`: where the vertices are. README.md section 6.

namespace weft::proto {

enum FrameFlag : std::uint8_t {
  kFrameKey = 1,   ///< builds on no other frame
  kFrameJump = 2,  ///< the state was replaced; not to be interpolated to
  kFramePaused = 4,
};

struct FrameHeader {
  std::uint8_t flags = kFrameKey;
  std::uint64_t tick = 0;
  double time = 0;              ///< simulated [s]
  double server_time = 0;       ///< server's clock when the tick was done [s]
  std::uint32_t sequence = 0;   ///< counts the room's frames
  std::uint32_t reference = 0;  ///< sequence of the frame it builds on; its own if on none
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

/// How far a viewer's messages are contained in this frame.
struct AppliedCommand {
  ViewerId viewer = 0;
  std::uint32_t number = 0;  ///< of the last text message, counted from 1
  bool operator==(const AppliedCommand&) const = default;
};
static_assert(sizeof(AppliedCommand) == 8);

/// A collider that is not as the mesh message tells it.
struct PoseSample {
  std::uint32_t collider = 0;  ///< its place in the list of the text message
  Vec3f position{};            ///< of its pivot [m]
  Quatf rotation{};            ///< about it, from how it was told
  bool operator==(const PoseSample&) const = default;
};
static_assert(sizeof(PoseSample) == 32);

/// A contact of the cloth.
struct ContactSample {
  std::uint32_t collider = 0;  ///< place of the object in the text message; kNoCollider: cloth
  std::uint32_t particle = 0;  ///< of the cloth, that which has most to do with it
  Vec3f point{}, normal{};     ///< of the mid-surface [m]; unit, out of the other side
  float gap = 0;               ///< from the mid-surface to the other side [m]
  float normal_force = 0;      ///< on the cloth, along the normal [N]
  Vec3f friction{};            ///< on the cloth, across the normal [N]
  bool operator==(const ContactSample&) const = default;
};
static_assert(sizeof(ContactSample) == 52);
inline constexpr std::uint32_t kNoCollider = 0xffffffff;

/// Who gives a force to the cloth, or gets one from it.
enum class ReactionOf : std::uint32_t {
  pin = 0,       ///< `id` names the pin; force on the cloth
  collider = 1,  ///< `id` is its place in the text message; force of the cloth on it
};

struct ReactionSample {
  ReactionOf of = ReactionOf::pin;
  std::uint32_t id = 0;
  Vec3f force{};  ///< [N]
  bool operator==(const ReactionSample&) const = default;
};
static_assert(sizeof(ReactionSample) == 20);

/// What is encoded; the arrays stay the caller's.
struct FrameView {
  FrameHeader header;
  std::span<const float> positions;  ///< three a vertex [m], finite
  std::span<const GrabSample> grabs;
  std::span<const AppliedCommand> applied;
  std::span<const PoseSample> poses;
  std::span<const ContactSample> contacts;
  std::span<const ReactionSample> reactions;
};

/// Writes codec f32. `out` keeps its capacity from frame to frame, so a steady stream allocates
/// nothing. Sections without items are left out, but for positions.
void encode_frame(const FrameView& frame, Bytes& out);

/// A decoded frame.
struct Frame {
  FrameHeader header;
  std::vector<float> positions;  ///< three a vertex [m]
  std::vector<GrabSample> grabs;
  std::vector<AppliedCommand> applied;
  std::vector<PoseSample> poses;
  std::vector<ContactSample> contacts;
  std::vector<ReactionSample> reactions;
};

/// Accepts exactly what README.md allows, with finite positions. Never reads outside `message`.
Result<Frame> decode_frame(std::span<const std::byte> message);

}  // namespace weft::proto
