#include <algorithm>
#include <bit>
#include <functional>
#include <random>
#include <string>
#include <variant>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "proto/frames/frame.h"
#include "proto/frames/mesh.h"
#include "proto/messages/data.h"
#include "tests/proto/golden.h"
#include "tests/proto/guarded_bytes.h"

using namespace weft::proto;
using namespace weft::test;
using nlohmann::json;

namespace {

Vec3f vec3_of(const json& list) {
  return {list[0], list[1], list[2]};
}

GrabSample grab_of(const json& g) {
  return {g["id"], g["viewer"], vec3_of(g["held"]), vec3_of(g["target"]), g["force"]};
}

FrameHeader frame_header_of(const json& h) {
  return {h["flags"],    h["tick"],      h["time"], h["server_time"],
          h["sequence"], h["reference"], h["epoch"]};
}

std::vector<GrabSample> grabs_of(const json& content) {
  std::vector<GrabSample> grabs;
  for (const json& g : content["grabs"]) grabs.push_back(grab_of(g));
  return grabs;
}

std::vector<AppliedCommand> applied_of(const json& content) {
  std::vector<AppliedCommand> applied;
  for (const json& a : content["applied"]) applied.push_back({a["viewer"], a["number"]});
  return applied;
}

std::vector<PoseSample> poses_of(const json& content) {
  std::vector<PoseSample> poses;
  for (const json& p : content["poses"]) {
    const json& q = p["rotation"];
    poses.push_back({p["collider"], vec3_of(p["position"]), {q[0], q[1], q[2], q[3]}});
  }
  return poses;
}

std::vector<ContactSample> contacts_of(const json& content) {
  std::vector<ContactSample> contacts;
  for (const json& c : content["contacts"])
    contacts.push_back({c["collider"].is_null() ? kNoCollider : c["collider"].get<std::uint32_t>(),
                        c["particle"], vec3_of(c["point"]), vec3_of(c["normal"]), c["gap"],
                        c["normal_force"], vec3_of(c["friction"])});
  return contacts;
}

std::vector<ReactionSample> reactions_of(const json& content) {
  std::vector<ReactionSample> reactions;
  for (const json& r : content["reactions"]) {
    const json& of = r["of"];
    const auto kind = of == "pin"        ? ReactionOf::pin
                      : of == "collider" ? ReactionOf::collider
                                         : static_cast<ReactionOf>(of.get<std::uint32_t>());
    reactions.push_back({kind, r["id"], vec3_of(r["force"])});
  }
  return reactions;
}

std::vector<GripperSample> grippers_of(const json& content) {
  std::vector<GripperSample> grippers;
  for (const json& g : content["grippers"])
    grippers.push_back({g["jaw"], g["gripping"].get<bool>() ? 1U : 0U, vec3_of(g["position"]),
                        g["rotation"].get<Quatf>(), g["opening"], g["force"],
                        vec3_of(g["reaction"]), vec3_of(g["torque"])});
  return grippers;
}

SceneMesh mesh_of(const json& content) {
  SceneMesh mesh;
  mesh.rest_positions = content["rest_positions"].get<std::vector<float>>();
  mesh.triangles = content["triangles"].get<std::vector<std::uint32_t>>();
  mesh.uv = content["uv"].get<std::vector<float>>();
  for (const json& c : content["colliders"]) {
    mesh.colliders.push_back({c["collider"], c["positions"].get<std::vector<float>>(),
                              c["triangles"].get<std::vector<std::uint32_t>>()});
  }
  return mesh;
}

Bytes first_bytes(const Bytes& message, std::size_t length) {
  return {message.begin(), message.begin() + static_cast<std::ptrdiff_t>(length)};
}

// Whether a message of any type is accepted, read next to an unreadable page.
bool accepts(const std::string& type, const Bytes& message) {
  const GuardedBytes guarded(message);
  if (type == "frame") return decode_frame(guarded.view()).has_value();
  if (type == "mesh") return decode_mesh_data(guarded.view()).has_value();
  return decode_data(guarded.view()).has_value();
}

void for_each_golden(const std::function<void(const std::string&, const json&, const Bytes&)>& f) {
  const json goldens = read_golden_json("binary.json");
  for (const auto& [name, content] : goldens.items()) {
    INFO(name);
    f(name, content, read_golden_bytes(name + ".bin"));
  }
}

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace

TEST_CASE("Golden frames are read bit for bit and written byte for byte") {
  for_each_golden([](const std::string&, const json& content, const Bytes& message) {
    if (content["type"] != "frame") return;
    const Result<Frame> frame = decode_frame(message);
    REQUIRE(frame.has_value());
    const auto positions = content["positions"].get<std::vector<float>>();
    CHECK(frame->header == frame_header_of(content["header"]));
    REQUIRE(frame->positions.size() == positions.size());
    CHECK(std::equal(positions.begin(), positions.end(), frame->positions.begin(), same_bits));
    CHECK(frame->grabs == grabs_of(content));
    CHECK(frame->applied == applied_of(content));
    CHECK(frame->poses == poses_of(content));
    CHECK(frame->contacts == contacts_of(content));
    CHECK(frame->reactions == reactions_of(content));
    CHECK(frame->velocities == content["velocities"].get<std::vector<float>>());
    CHECK(frame->grippers == grippers_of(content));
    if (!content["encoder_writes_it"]) return;
    Bytes written(3);  // what is in the buffer before does not matter
    encode_frame({frame->header, frame->positions, frame->grabs, frame->applied, frame->poses,
                  frame->contacts, frame->reactions, frame->velocities, frame->grippers},
                 written);
    CHECK(written == message);
  });
}

TEST_CASE("Golden meshes are read and written byte for byte") {
  for_each_golden([](const std::string&, const json& content, const Bytes& message) {
    if (content["type"] != "mesh") return;
    const Result<SceneMesh> mesh = decode_mesh_data(message);
    REQUIRE(mesh.has_value());
    CHECK(*mesh == mesh_of(content));
    if (content["encoder_writes_it"]) CHECK(encode_mesh_data(*mesh) == message);
  });
}

TEST_CASE("The length of a mesh message is known before it is written") {
  for_each_golden([](const std::string&, const json& content, const Bytes& message) {
    if (content["type"] != "mesh" || !content["encoder_writes_it"]) return;
    const SceneMesh mesh = *decode_mesh_data(message);
    MeshSize size{
        mesh.rest_positions.size() / 3, mesh.triangles.size() / 3, !mesh.order.empty(), {}};
    for (const ColliderMesh& collider : mesh.colliders)
      size.colliders.push_back({collider.positions.size() / 3, collider.triangles.size() / 3});
    CHECK(mesh_data_bytes(size) == message.size());
  });
}

TEST_CASE("Golden data is read and written byte for byte, with the announced size") {
  for_each_golden([](const std::string&, const json& content, const Bytes& message) {
    if (content["type"] != "data") return;
    const Result<Data> data = decode_data(message);
    REQUIRE(data.has_value());
    const DataHeader header{content["tick"], content["transfer"], content["components"]};
    CHECK(data->header == header);
    const bool single = content["format"] == "f32";
    CHECK(data->values.index() == (single ? 0 : 1));
    if (single) {
      CHECK(std::get<0>(data->values) == content["values"].get<std::vector<float>>());
    } else {
      CHECK(std::get<1>(data->values) == content["values"].get<std::vector<double>>());
    }
    const auto encode = [&header](const auto& values) {
      return encode_data(header, std::span(values));
    };
    CHECK(std::visit(encode, data->values) == message);
    CHECK(data_message_bytes(single ? QueryFormat::f32 : QueryFormat::f64,
                             content["values"].size() / header.components,
                             header.components) == message.size());
  });
}

TEST_CASE("The golden ack is read and written, and nothing else is an ack") {
  const Bytes ack = read_golden_bytes("ack.bin");
  CHECK(encode_ack(4294967294U) == ack);
  CHECK(*decode_ack(ack) == 4294967294U);
  for (std::size_t length = 0; length < ack.size(); ++length)
    CHECK_FALSE(decode_ack(std::span(ack).first(length)).has_value());
  for (std::size_t byte = 0; byte < 4; ++byte) {
    Bytes changed = ack;
    changed[byte] ^= std::byte{64};
    CHECK_FALSE(decode_ack(changed).has_value());
  }
  Bytes longer = ack;
  longer.push_back(std::byte{0});
  CHECK_FALSE(decode_ack(longer).has_value());
}

TEST_CASE("Each binary message that breaks a rule is refused though its checksum is right") {
  for (const json& golden : read_golden_json("refused_binary.json")) {
    INFO(golden["type"] << ": " << golden["rule"]);
    CHECK_FALSE(accepts(golden["type"], bytes_of_hex(golden["hex"])));
  }
}

TEST_CASE("A message cut anywhere or with a byte more is refused") {
  for_each_golden([](const std::string&, const json& content, const Bytes& message) {
    for (std::size_t length = 0; length < message.size(); ++length) {
      INFO("cut to " << length);
      CHECK_FALSE(accepts(content["type"], first_bytes(message, length)));
    }
    Bytes longer = message;
    longer.push_back(std::byte{0});
    CHECK_FALSE(accepts(content["type"], longer));
  });
}

TEST_CASE("A message with any one bit flipped is refused") {
  for_each_golden([](const std::string&, const json& content, const Bytes& message) {
    for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
      INFO("bit " << bit);
      Bytes changed = message;
      changed[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
      CHECK_FALSE(accepts(content["type"], changed));
    }
  });
}

// With length and checksum put right a decoder meets every later check. Whether it accepts is its
// business; it must not crash or read outside, which the unreadable page shows.
TEST_CASE("Bytes cut or changed behind a right checksum are survived") {
  std::mt19937 random(7);
  std::size_t accepted = 0, refused = 0;
  for_each_golden([&](const std::string&, const json& content, const Bytes& message) {
    const auto survive = [&](const Bytes& changed) {
      ++(accepts(content["type"], changed) ? accepted : refused);
    };
    for (std::size_t length = 0; length <= message.size(); ++length)
      survive(sealed(first_bytes(message, length)));
    for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
      Bytes changed = message;
      changed[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
      survive(sealed(changed));
    }
    for (int round = 0; round < 2000; ++round) {
      Bytes changed = message;
      for (int i = 0; i < 4; ++i) {
        const std::byte value{static_cast<unsigned char>(random() % 3 == 0 ? 255 : random() % 256)};
        changed[random() % changed.size()] = value;
      }
      survive(sealed(changed));
    }
  });
  CHECK(accepted > 1000);
  CHECK(refused > 1000);
}

TEST_CASE("A frame is written into the buffer that the last one used") {
  const std::vector<float> positions(300, 1.5F);
  Bytes buffer;
  encode_frame({FrameHeader{}, positions, {}, {}, {}, {}, {}}, buffer);
  const std::byte* storage = buffer.data();
  encode_frame({FrameHeader{}, positions, {}, {}, {}, {}, {}}, buffer);
  CHECK(buffer.data() == storage);
}

TEST_CASE("The content hash is XXH64 with seed 0") {
  // The figures are those of the xxHash specification's reference program for "" and "abc".
  CHECK(content_hash({}) == 0xef46db3751d8e999ULL);
  const char text[] = {'a', 'b', 'c'};
  CHECK(content_hash(std::as_bytes(std::span(text))) == 0x44bc2cf5ad770999ULL);
}
