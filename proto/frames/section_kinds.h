#pragma once

#include <cstdint>

namespace weft::proto {

/// Kinds of sections in frames and meshes, in one number space.
enum SectionKind : std::uint16_t {
  kPositions = 1,
  kGrabs = 2,
  kApplied = 3,
  kPoses = 4,
  kContacts = 5,
  kReactions = 6,
  kPackedPositions = 7,
  kVelocities = 8,
  kGrippers = 9,
  kRestPositions = 16,
  kTriangles = 17,
  kUv = 18,
  kColliderPositions = 19,
  kColliderTriangles = 20,
  kOrder = 21,
};

}  // namespace weft::proto
