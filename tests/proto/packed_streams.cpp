#include "tests/proto/packed_streams.h"

#include <cstddef>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "proto/frames/mesh.h"
#include "tests/proto/golden.h"

namespace weft::test {
namespace {

using proto::Bytes;

std::vector<Bytes> cut(const Bytes& stream) {
  std::vector<Bytes> messages;
  for (std::size_t at = 0; at < stream.size();) {
    const auto length = proto::read_at<std::uint32_t>(stream, at + 4);
    const auto begin = stream.begin() + static_cast<std::ptrdiff_t>(at);
    messages.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(length));
    at += length;
  }
  return messages;
}

proto::codec::CodingOrder order_of(const proto::SceneMesh& mesh, const nlohmann::json& cloths) {
  const auto vertices = static_cast<std::uint32_t>(mesh.rest_positions.size() / 3);
  if (!mesh.order.empty()) return *proto::codec::read_order(mesh.order, vertices);
  std::vector<proto::codec::ClothRange> ranges;
  for (const auto& cloth : cloths)
    ranges.push_back(
        {cloth["first_vertex"], cloth["vertices"], 0, 0, cloth["rows"], cloth["columns"]});
  return proto::codec::make_order(mesh.rest_positions, mesh.triangles, ranges);
}

}  // namespace

PackedStream packed_stream(const std::string& name) {
  const std::vector<Bytes> messages = cut(read_golden_bytes(name + ".bin"));
  PackedStream stream{name, messages.front(), {}, {}};
  const auto mesh = proto::decode_mesh_data(stream.mesh);
  REQUIRE(mesh.has_value());
  stream.order = order_of(*mesh, read_golden_json("packed.json")[name]["cloths"]);
  for (std::size_t i = 1; i + 1 < messages.size(); i += 2)
    stream.frames.emplace_back(messages[i], messages[i + 1]);
  return stream;
}

void for_each_packed_stream(const std::function<void(const PackedStream&)>& visit) {
  const nlohmann::json goldens = read_golden_json("packed.json");
  for (const auto& [name, content] : goldens.items()) {
    if (name == "refused") continue;
    INFO(name);
    visit(packed_stream(name));
  }
}

}  // namespace weft::test
