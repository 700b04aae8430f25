// Frames reach a viewer by two ways, a queue for those of its own `advance` and a slot for the
// newest: none comes after a newer one, and each jump of the state is told once.

#include <algorithm>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "proto/frames/packed_frame.h"
#include "server/net/hub.h"
#include "tests/server/fakes.h"
#include "tests/server/welcomed_viewer.h"

namespace weft::server {
namespace {

constexpr std::uint32_t kVertices = 4;

PackedMesh square() {
  const proto::codec::ClothRange cloth{0, kVertices, 0, 0, 2, 2};
  const std::vector<float> rest(3 * kVertices);
  return {1, std::make_shared<const proto::codec::CodingOrder>(
                 proto::codec::make_order(rest, {}, {&cloth, 1}))};
}

Frame frame_of(std::uint32_t sequence, bool jump) {
  proto::FrameView view;
  view.header.tick = view.header.sequence = view.header.reference = sequence;
  view.header.epoch = 1;
  if (jump) view.header.flags |= proto::kFrameJump;
  const std::vector<float> positions(3 * kVertices, 0.001F * static_cast<float>(sequence));
  view.positions = positions;
  proto::Bytes bytes;
  proto::encode_frame(view, bytes);
  Frame frame{SharedBytes(std::move(bytes)), sequence};
  frame.jump = frame.at_once = jump;
  return frame;
}

/// What a viewer has been sent; each packed frame builds on those before.
std::vector<proto::FrameHeader> headers_of(const std::vector<std::string>& written) {
  std::vector<proto::FrameHeader> headers;
  proto::codec::FrameDecoder decoder;
  decoder.begin(*square().order);
  for (const std::string& bytes : written) {
    const auto frame = decoder.decode(std::as_bytes(std::span(bytes)));
    REQUIRE(frame.has_value());
    headers.push_back(frame->header);
  }
  return headers;
}

bool is_jump(const proto::FrameHeader& header) {
  return (header.flags & proto::kFrameJump) != 0;
}

/// A viewer that is sent frames by both ways in a random order, reads and acknowledges when it
/// likes, and at times declines frames.
struct RandomViewer : OneViewer {
  explicit RandomViewer(unsigned seed, bool packed) : random(seed) {
    packer.begin(square());
    if (packed) channel.pack_with(packer, 1e-4, 1e-4);
  }

  bool one_in(int n) { return std::uniform_int_distribution(1, n)(random) == 1; }

  void act() {
    fake.now += one_in(2) ? 0.02 : 0.001;
    if (one_in(3)) {
      const bool jump = one_in(4);
      Frame frame = frame_of(++sequence, jump);
      if (jump) jumps.push_back(sequence);
      channel.offer_frame(frame);
    }
    if (one_in(5)) channel.send({frame_of(++sequence, false).bytes, true, Topic::frame});
    if (one_in(40)) channel.set_most_frames(channel.most_frames() > 0 ? 0 : 60);
    if (one_in(3) && stream.in_flight > 0) stream.finish_write();
    if (one_in(4) && !stream.written.empty())
      channel.on_acknowledged(headers_of(stream.written).back().sequence);
  }

  std::mt19937 random;
  FramePacker packer;
  std::uint32_t sequence = 0;
  std::vector<std::uint32_t> jumps;  ///< sequences of the frames that told them at first
};

TEST_CASE("whatever way frames take, a viewer is sent none that is older than the one before") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RandomViewer v(seed, seed % 2 == 0);
    for (int k = 0; k < 200; ++k) v.act();
    v.stream.drain();
    const auto headers = headers_of(v.stream.written);
    REQUIRE(headers.size() > 10);
    for (std::size_t k = 1; k < headers.size(); ++k)
      CHECK(headers[k].sequence > headers[k - 1].sequence);
  }
}

TEST_CASE("the first frame that is sent after a jump tells it, and is a key; no other does") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RandomViewer v(seed, seed % 2 == 0);
    for (int k = 0; k < 200; ++k) v.act();
    v.stream.drain();
    REQUIRE(v.jumps.size() > 3);
    std::uint32_t before = 0;
    for (const proto::FrameHeader& header : headers_of(v.stream.written)) {
      const bool jumped = std::any_of(v.jumps.begin(), v.jumps.end(), [&](std::uint32_t jump) {
        return jump > before && jump <= header.sequence;
      });
      CHECK(is_jump(header) == jumped);
      if (jumped) CHECK((header.flags & proto::kFrameKey) != 0);
      before = header.sequence;
    }
  }
}

std::vector<bool> jumps_of(const RecordingOutput& output) {
  std::vector<bool> jumps;
  for (const auto& [viewer, bytes] : output.kept_frames)
    jumps.push_back(is_jump(proto::decode_frame(std::as_bytes(std::span(bytes)))->header));
  return jumps;
}

TEST_CASE("of the frames of an advance that follows a reset at once the first tells the jump") {
  for (const std::string wanted : {"last", "all"}) {
    TestRoom t;
    t.join(1);
    t.room->finish_turn();
    t.tell(1, R"({"op":"reset"})");
    t.say(1, R"({"op":"advance","id":1,"n":3,"frames":")" + wanted + R"("})");
    std::vector<bool> expected(wanted == "all" ? 3 : 1, false);
    expected.front() = true;
    CHECK(jumps_of(t.output) == expected);
    CHECK_FALSE(t.output.offered.back().owes_jump);
    t.say(1, R"({"op":"advance","id":2,"n":1,"frames":"last"})");
    CHECK_FALSE(jumps_of(t.output).back());
  }
}

TEST_CASE("a viewer that declines the frames of its advance is told the jump by its next one") {
  TestRoom t;
  t.join(1);
  t.room->finish_turn();
  t.tell(1, R"({"op":"reset"})");
  t.say(1, R"({"op":"advance","id":1,"n":3,"frames":"none"})");
  REQUIRE(t.output.offered.back().jump);
  REQUIRE(t.output.offered.back().not_to == 1);
  CHECK(t.output.offered.back().owes_jump);

  WelcomedViewer viewer;
  auto& [fake, metrics, hub, stream] = viewer;
  Frame others = frame_of(1, true);
  others.not_to = 1;
  others.owes_jump = true;
  hub.offer_frame(others);
  hub.send(1, {frame_of(2, false).bytes, true, Topic::frame});
  hub.offer_frame(frame_of(3, false));
  fake.now += 1;
  stream.drain();
  const auto headers = headers_of(stream.written);
  REQUIRE(headers.size() == 2);
  CHECK(is_jump(headers[0]));
  CHECK_FALSE(is_jump(headers[1]));
}

}  // namespace
}  // namespace weft::server
