#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/binary.h"
#include "proto/error.h"
#include "proto/field.h"
#include "proto/types.h"

// The binary message `frame`: positions of the vertices, and lists of hands, contacts and the like
// at its tick. README.md section 6. Flags, lists and arrays are described once, here: encoder and
// decoder walk the descriptions, and generate.py writes the clients' readers and the page's tables
// of them; positions and the key bit, which decide how to decode, the clients know themselves. The
// walker of a list's entries has, beside `required`,
//
//   truth(Field, value)             of 32 bits, 0 or 1
//   collider_or_none(Field, value)  a place in `colliders` of `mesh`, or kNoCollider

namespace weft::proto {

inline constexpr std::uint8_t kPackedCodec = 2;  ///< of frames; codec/packed_frame.h reads it

enum FrameFlag : std::uint8_t {
  kFrameKey = 1,
  kFrameJump = 2,
  kFramePaused = 4,
  kFrameObserved = 8,
};

struct FlagText {
  FrameFlag flag;
  const char* name;
  const char* meaning;
};
inline constexpr FlagText kFrameFlags[] = {
    {kFrameKey, "key", "it builds on no other frame (always in codec 0)"},
    {kFrameJump, "jump",
     "the state was replaced (reset, load, recovery), so do not interpolate to it"},
    {kFramePaused, "paused", "the room is paused"},
    {kFrameObserved, "observed", "it has what `observe` of an `advance` asked for"},
};

/// Sections of a frame; those of a mesh (mesh.h) have numbers from 16.
enum FrameSection : std::uint16_t {
  kPositions = 1,
  kGrabs = 2,
  kApplied = 3,
  kPoses = 4,
  kContacts = 5,
  kReactions = 6,
  kPackedPositions = 7,
  kVelocities = 8,
  kGrippers = 9,
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

/// A hand.
struct GrabSample {
  std::uint32_t id = 0;
  ViewerId viewer = 0;
  Vec3f held{}, target{};
  float force = 0;
  bool operator==(const GrabSample&) const = default;

  static constexpr const char* kName = "GrabSample";
  static constexpr const char* kEach = "hand";
  static void describe(auto& io, auto& grab) {
    io.required(Field{"id", ""}, grab.id);
    io.required(Field{"viewer", "0: the scene"}, grab.viewer);
    io.required(Field{"held", "the point of the cloth", {}, "m"}, grab.held);
    io.required(Field{"target", "where the hand is", {}, "m"}, grab.target);
    io.required(Field{"force", "magnitude", {}, "N"}, grab.force);
  }
};
static_assert(sizeof(GrabSample) == 36);

/// How many of a viewer's messages this frame includes.
struct AppliedCommand {
  ViewerId viewer = 0;
  std::uint32_t number = 0;
  bool operator==(const AppliedCommand&) const = default;

  static constexpr const char* kName = "AppliedCommand";
  static constexpr const char* kEach = "viewer that has sent something";
  static void describe(auto& io, auto& applied) {
    io.required(Field{"viewer", ""}, applied.viewer);
    io.required(Field{"number", "of its last text message that this frame includes, from 1"},
                applied.number);
  }
};
static_assert(sizeof(AppliedCommand) == 8);

/// A collider whose pose differs from the mesh message.
struct PoseSample {
  std::uint32_t collider = 0;
  Vec3f position{};
  Quatf rotation{};
  bool operator==(const PoseSample&) const = default;

  static constexpr const char* kName = "PoseSample";
  static constexpr const char* kEach = "collider that is not as defined";
  static void describe(auto& io, auto& pose) {
    io.required(Field{"collider", "its place in `colliders` of `mesh`"}, pose.collider);
    io.required(Field{"position", "of its pivot", {}, "m"}, pose.position);
    io.required(Field{"rotation", "unit quaternion x y z w"}, pose.rotation);
  }
};
static_assert(sizeof(PoseSample) == 32);

inline constexpr std::uint32_t kNoCollider = 0xffffffff;

/// A contact of the cloth.
struct ContactSample {
  std::uint32_t collider = 0;
  std::uint32_t particle = 0;
  Vec3f point{}, normal{};
  float gap = 0;
  float normal_force = 0;
  Vec3f friction{};
  bool operator==(const ContactSample&) const = default;

  static constexpr const char* kName = "ContactSample";
  static constexpr const char* kEach = "contact of the cloth";
  static void describe(auto& io, auto& contact) {
    io.collider_or_none(
        Field{"collider", "the other side's place in `colliders` of `mesh`; none for cloth"},
        contact.collider);
    io.required(Field{"particle", "of the cloth, with the largest weight"}, contact.particle);
    io.required(Field{"point", "of the cloth's mid-surface", {}, "m"}, contact.point);
    io.required(Field{"normal", "unit, out of the other side"}, contact.normal);
    io.required(Field{"gap", "from the mid-surface to the other side", {}, "m"}, contact.gap);
    io.required(Field{"normal_force", "on the cloth, along the normal", {}, "N"},
                contact.normal_force);
    io.required(Field{"friction", "on the cloth, tangential", {}, "N"}, contact.friction);
  }
};
static_assert(sizeof(ContactSample) == 52);

/// The partner of a reaction force.
enum class ReactionOf : std::uint32_t { pin = 0, collider = 1 };
template <>
inline constexpr std::array<const char*, 2> kWords<ReactionOf> = {"pin", "collider"};

struct ReactionSample {
  ReactionOf of = ReactionOf::pin;
  std::uint32_t id = 0;
  Vec3f force{};
  bool operator==(const ReactionSample&) const = default;

  static constexpr const char* kName = "ReactionSample";
  static constexpr const char* kEach = "pin or collider that bears the cloth";
  static void describe(auto& io, auto& reaction) {
    io.required(Field{"of", "whose it is"}, reaction.of);
    io.required(Field{"id", "of the pin, or the collider's place in `colliders` of `mesh`"},
                reaction.id);
    io.required(Field{"force", "of a pin on the cloth, of the cloth on a collider", {}, "N"},
                reaction.force);
  }
};
static_assert(sizeof(ReactionSample) == 20);

/// A gripper at the end of the tick.
struct GripperSample {
  std::uint32_t jaw = 0;
  std::uint32_t gripping = 0;
  Vec3f position{};
  Quatf rotation{};
  float opening = 0;
  float force = 0;
  Vec3f reaction{};
  Vec3f torque{};
  bool operator==(const GripperSample&) const = default;

  static constexpr const char* kName = "GripperSample";
  static constexpr const char* kEach = "gripper";
  static void describe(auto& io, auto& gripper) {
    io.required(
        Field{"jaw", "its left jaw's place in `colliders` of `mesh`; the right one follows"},
        gripper.jaw);
    io.truth(Field{"gripping", "it presses something"}, gripper.gripping);
    io.required(Field{"position", "of its middle", {}, "m"}, gripper.position);
    io.required(Field{"rotation", "from its definition, unit quaternion x y z w"},
                gripper.rotation);
    io.required(Field{"opening", "between its jaws", {}, "m"}, gripper.opening);
    io.required(Field{"force", "most that each jaw presses with", {}, "N"}, gripper.force);
    io.required(Field{"reaction", "of the cloth on both jaws, mean of the tick", {}, "N"},
                gripper.reaction);
    io.required(Field{"torque", "the same about its middle", {}, "N m"}, gripper.torque);
  }
};
static_assert(sizeof(GripperSample) == 68);

/// A list of samples, or an array of three numbers per vertex, that a frame may have.
struct FramePart {
  FrameSection kind;
  const char* name;       ///< of the member
  const char* note = "";  ///< what is said of it beside its entries
  bool keyed = false;     ///< its entries differ in their first fields
  const char* unit = "";  ///< of an array's numbers
};

inline constexpr FramePart kPositionsPart{kPositions, "positions",
                                          "always there in codec 0, never in codec 2", false, "m"};
inline constexpr FramePart kPackedPositionsPart{kPackedPositions, "packed positions",
                                                "section 10; always there in codec 2"};

/// Passes each list of a frame to `visit`, in the order of the message.
template <class AnyFrame, class Visitor>
void visit_lists(AnyFrame& frame, Visitor&& visit) {
  visit(FramePart{kGrabs, "grabs"}, frame.grabs);
  visit(FramePart{kApplied, "applied", "", true}, frame.applied);
  visit(FramePart{kPoses, "poses", "its point p is at position + rotation (p - pivot)", true},
        frame.poses);
  visit(FramePart{kContacts, "contacts", "if `view` or `observe` asked for them; as in `query`"},
        frame.contacts);
  visit(FramePart{kReactions, "reactions", "if `view` or `observe` asked for them; as in `query`"},
        frame.reactions);
  visit(FramePart{kGrippers, "grippers", "if `observe` asked for them; as in `query`"},
        frame.grippers);
}

/// Passes each array beside the positions, in the order of the message; they follow the lists.
template <class AnyFrame, class Visitor>
void visit_arrays(AnyFrame& frame, Visitor&& visit) {
  visit(FramePart{kVelocities, "velocities", "if `observe` asked for them", false, "m/s"},
        frame.velocities);
}

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

/// A frame message of any codec with the flag *jump*, whether it has it or not.
Bytes with_jump(std::span<const std::byte> message);

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
