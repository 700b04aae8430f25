#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/binary.h"
#include "proto/error.h"

// The binary message `mesh`: everything constant during an epoch. README.md section 7.

namespace weft::proto {

/// Sections of a mesh; those of a frame (frame.h) have numbers below 16.
enum MeshSection : std::uint16_t {
  kRestPositions = 16,
  kTriangles = 17,
  kUv = 18,
  kColliderPositions = 19,
  kColliderTriangles = 20,
  kOrder = 21,
};

struct ColliderMesh {
  std::uint16_t collider = 0;            ///< its index in the list of the text message
  std::vector<float> positions;          ///< three per vertex [m]
  std::vector<std::uint32_t> triangles;  ///< three per triangle, counter-clockwise from outside
  bool operator==(const ColliderMesh&) const = default;
};

struct SceneMesh {
  std::vector<float> rest_positions;     ///< three per vertex [m]
  std::vector<std::uint32_t> triangles;  ///< three per triangle, each below the number of vertices
  std::vector<float> uv;                 ///< two per vertex
  std::vector<ColliderMesh> colliders;   ///< ascending by `collider`
  std::vector<std::uint32_t> order;      ///< of the codec `packed`, if a cloth is not a grid; else
                                         ///< empty: codec/order.h
  bool operator==(const SceneMesh&) const = default;
};

/// How much a SceneMesh holds, as far as its message grows with it.
struct MeshSize {
  std::size_t vertices = 0, triangles = 0;  ///< of cloth
  bool has_order = false;
  struct Object {
    std::size_t vertices = 0, triangles = 0;
  };
  std::vector<Object> colliders;
};

/// Length of the message of such a mesh [bytes].
std::size_t mesh_data_bytes(const MeshSize& size);

/// The message. The mesh must be as described in SceneMesh.
Bytes encode_mesh_data(const SceneMesh& mesh);

/// Accepts exactly what README.md allows: all indices in range, all numbers finite. Never reads
/// outside `message`.
Result<SceneMesh> decode_mesh_data(std::span<const std::byte> message);

/// XXH64 of a mesh message, its name over HTTP.
std::uint64_t content_hash(std::span<const std::byte> message);

}  // namespace weft::proto
