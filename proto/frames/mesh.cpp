#include "proto/frames/mesh.h"

#define XXH_INLINE_ALL
#include <algorithm>
#include <cmath>
#include <utility>

#include <xxhash.h>

#include "proto/codec/order.h"
#include "proto/types.h"

namespace weft::proto {
namespace {

struct MeshFields {
  std::uint32_t vertices, triangles, collider_meshes, sections;
};
constexpr std::size_t kMeshBytes = kCommonBytes + sizeof(MeshFields);
constexpr std::size_t kOrderBytes = 4 * sizeof(std::uint32_t);  // of a vertex
constexpr std::size_t kTriangleBytes = 3 * sizeof(std::uint32_t);

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

bool all_below(const std::vector<std::uint32_t>& indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(),
                     [count](std::uint32_t i) { return i < count; });
}

const Section* find_section(const std::vector<Section>& sections, std::uint16_t kind,
                            std::uint16_t index) {
  const auto it = std::find_if(sections.begin(), sections.end(), [=](const Section& s) {
    return s.kind == kind && s.index == index;
  });
  return it == sections.end() ? nullptr : &*it;
}

template <class T>
bool read_exactly(const Section* section, std::size_t bytes, std::vector<T>& items) {
  if (section == nullptr || section->payload.size() != bytes) return false;
  items = read_array<T>(section->payload);
  return true;
}

bool read_cloth(const std::vector<Section>& sections, const MeshFields& fields, SceneMesh& mesh) {
  const std::size_t vertices = fields.vertices, triangles = fields.triangles;
  return read_exactly(find_section(sections, kRestPositions, 0), vertices * sizeof(Vec3f),
                      mesh.rest_positions) &&
         read_exactly(find_section(sections, kTriangles, 0), triangles * kTriangleBytes,
                      mesh.triangles) &&
         read_exactly(find_section(sections, kUv, 0), vertices * 2 * sizeof(float), mesh.uv) &&
         all_finite(mesh.rest_positions) && all_finite(mesh.uv) &&
         all_below(mesh.triangles, vertices);
}

bool read_collider(const Section& positions, const Section* triangles, ColliderMesh& collider) {
  if (triangles == nullptr || positions.payload.size() % sizeof(Vec3f) != 0 ||
      triangles->payload.size() % kTriangleBytes != 0)
    return false;
  collider.collider = positions.index;
  collider.positions = read_array<float>(positions.payload);
  collider.triangles = read_array<std::uint32_t>(triangles->payload);
  return all_finite(collider.positions) &&
         all_below(collider.triangles, collider.positions.size() / 3);
}

bool read_colliders(const std::vector<Section>& sections, const MeshFields& fields,
                    SceneMesh& mesh) {
  std::size_t triangle_sections = 0;
  for (const Section& section : sections) {
    triangle_sections += section.kind == kColliderTriangles ? 1 : 0;
    if (section.kind != kColliderPositions) continue;
    ColliderMesh collider;
    const Section* triangles = find_section(sections, kColliderTriangles, section.index);
    if (!read_collider(section, triangles, collider)) return false;
    mesh.colliders.push_back(std::move(collider));
  }
  std::sort(mesh.colliders.begin(), mesh.colliders.end(),
            [](const ColliderMesh& a, const ColliderMesh& b) { return a.collider < b.collider; });
  return mesh.colliders.size() == fields.collider_meshes &&
         triangle_sections == fields.collider_meshes;
}

bool read_order_of(const std::vector<Section>& sections, const MeshFields& fields,
                   SceneMesh& mesh) {
  const Section* section = find_section(sections, kOrder, 0);
  if (section == nullptr) return true;
  return read_exactly(section, std::size_t{fields.vertices} * kOrderBytes, mesh.order) &&
         codec::read_order(mesh.order, fields.vertices).has_value();
}

std::size_t section_bytes(std::size_t count, std::size_t item_bytes) {
  return kSectionHeaderBytes + padded(count * item_bytes);
}

}  // namespace

std::size_t mesh_data_bytes(const MeshSize& size) {
  std::size_t bytes = kMeshBytes + section_bytes(size.vertices, sizeof(Vec3f)) +
                      section_bytes(size.triangles, kTriangleBytes) +
                      section_bytes(size.vertices, 2 * sizeof(float));
  for (const MeshSize::Object& object : size.colliders)
    bytes += section_bytes(object.vertices, sizeof(Vec3f)) +
             section_bytes(object.triangles, kTriangleBytes);
  return bytes + (size.has_order ? section_bytes(size.vertices, kOrderBytes) : 0);
}

Bytes encode_mesh_data(const SceneMesh& mesh) {
  Bytes out;
  BinaryWriter writer(out, BinaryType::mesh, 0, 0);
  const auto colliders = static_cast<std::uint32_t>(mesh.colliders.size());
  writer.put(MeshFields{static_cast<std::uint32_t>(mesh.rest_positions.size() / 3),
                        static_cast<std::uint32_t>(mesh.triangles.size() / 3), colliders,
                        3 + 2 * colliders + (mesh.order.empty() ? 0 : 1)});
  writer.put_section(kRestPositions, 0, std::span(mesh.rest_positions));
  writer.put_section(kTriangles, 0, std::span(mesh.triangles));
  writer.put_section(kUv, 0, std::span(mesh.uv));
  for (const ColliderMesh& collider : mesh.colliders) {
    writer.put_section(kColliderPositions, collider.collider, std::span(collider.positions));
    writer.put_section(kColliderTriangles, collider.collider, std::span(collider.triangles));
  }
  if (!mesh.order.empty()) writer.put_section(kOrder, 0, std::span(mesh.order));
  writer.finish();
  return out;
}

Result<SceneMesh> decode_mesh_data(std::span<const std::byte> message) {
  const Result<BinaryHeader> common = read_header(message, BinaryType::mesh, kMeshBytes, 0);
  if (!common) return common.error();
  const auto fields = read_at<MeshFields>(message, kCommonBytes);
  Result<std::vector<Section>> sections = read_sections(message, kMeshBytes, fields.sections);
  if (!sections) return std::move(sections).error();
  SceneMesh mesh;
  if (!read_cloth(*sections, fields, mesh)) return binary_error("the cloth's sections do not fit");
  if (!read_colliders(*sections, fields, mesh))
    return binary_error("the colliders' sections do not fit");
  if (!read_order_of(*sections, fields, mesh)) return binary_error("the order does not fit");
  return mesh;
}

std::uint64_t content_hash(std::span<const std::byte> message) {
  return XXH64(message.data(), message.size(), 0);
}

}  // namespace weft::proto
