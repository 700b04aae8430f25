#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "proto/frames/packed_frame.h"
#include "server/net/hub.h"
#include "tests/server/fakes.h"

namespace weft::server {
namespace {

constexpr std::uint32_t kSide = 9, kVertices = kSide * kSide;

PackedMesh packed_mesh(std::uint32_t epoch = 1) {
  const proto::codec::ClothRange cloth{0, kVertices, 0, 0, kSide, kSide};
  const std::vector<float> rest(3 * kVertices);
  return {epoch, std::make_shared<const proto::codec::CodingOrder>(
                     proto::codec::make_order(rest, {}, {&cloth, 1}))};
}

/// A waving cloth at a tick, further off by `away` [m].
std::vector<float> positions_at(std::uint64_t tick, float away = 0) {
  std::vector<float> positions;
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    const auto u = static_cast<float>(i % kSide), v = static_cast<float>(i / kSide);
    const float t = 0.05F * static_cast<float>(tick);
    positions.insert(positions.end(),
                     {0.1F * u + away, 1 - 0.1F * v, 0.05F * v * std::sin(0.7F * u + t)});
  }
  return positions;
}

SharedBytes float_frame(std::uint32_t sequence, std::uint64_t tick, float away = 0,
                        std::uint8_t flags = proto::kFrameKey, std::uint32_t epoch = 1,
                        bool forces = false) {
  proto::FrameHeader header;
  header.flags = flags;
  header.tick = tick;
  header.sequence = header.reference = sequence;
  header.epoch = epoch;
  proto::Bytes bytes;
  const std::vector<float> positions = positions_at(tick, away);
  const std::vector<proto::ReactionSample> reactions(forces ? 2 : 0);
  proto::encode_frame({header, positions, {}, {}, {}, {}, reactions}, bytes);
  return SharedBytes(std::move(bytes));
}

std::span<const std::byte> bytes_of(const SharedBytes& message) {
  return {static_cast<const std::byte*>(message.data()), message.size()};
}

/// A viewer at the other end, which decodes all that it is sent.
struct Receiver {
  explicit Receiver(double error = 1e-4) {
    stream.error = error;
    decoder.begin(*packed_mesh().order);
  }

  /// Sends a frame; checks that it arrives as it was, within the bound.
  const proto::Frame& receive(FramePacker& packer, const SharedBytes& frame) {
    message = packer.pack(frame, stream);
    auto decoded = decoder.decode(bytes_of(message));
    REQUIRE(decoded.has_value());
    const auto plain = proto::decode_frame(bytes_of(frame));
    REQUIRE(plain.has_value());
    for (std::size_t i = 0; i < plain->positions.size(); ++i)
      CHECK(std::abs(plain->positions[i] - decoded->positions[i]) <= stream.error);
    last = std::move(*decoded);
    return last;
  }
  bool packed() const { return bytes_of(message)[2] == std::byte{proto::kPackedCodec}; }
  bool key() const { return last.header.reference == last.header.sequence; }

  PackedStream stream;
  proto::codec::FrameDecoder decoder;
  SharedBytes message;
  proto::Frame last;
};

struct Packing {
  Packing() { packer.begin(packed_mesh()); }
  FramePacker packer;
};

TEST_CASE("a first frame is a key and each other builds on the last one sent") {
  Packing p;
  Receiver viewer;
  for (std::uint32_t n = 1; n < 40; ++n) {
    viewer.receive(p.packer, float_frame(n, n));
    CHECK(viewer.packed());
    CHECK(viewer.last.header.reference == (n == 1 ? 1 : n - 1));
  }
}

TEST_CASE("viewers with the same frames share one encoding, and its bytes") {
  Packing p;
  std::vector<Receiver> viewers(20);
  for (std::uint32_t n = 1; n <= 30; ++n) {
    const SharedBytes frame = float_frame(n, n);
    for (Receiver& viewer : viewers) viewer.receive(p.packer, frame);
    CHECK(viewers[3].message.data() == viewers[17].message.data());
  }
  CHECK(p.packer.encodings() == 30);
}

TEST_CASE(
    "each bound has an encoding of its own, and frames with forces share that of those without") {
  Packing p;
  Receiver coarse, fine(1e-5), forces;
  for (std::uint32_t n = 1; n <= 10; ++n) {
    coarse.receive(p.packer, float_frame(n, n));
    fine.receive(p.packer, float_frame(n, n));
    CHECK(forces.receive(p.packer, float_frame(n, n, 0, proto::kFrameKey, 1, true))
              .reactions.size() == 2);
  }
  CHECK(p.packer.encodings() == 20);
}

TEST_CASE("viewers that miss any frames are still sent what they can read") {
  Packing p;
  std::mt19937 random(4);
  std::vector<Receiver> viewers(12);
  for (std::uint32_t n = 1; n <= 200; ++n) {
    const SharedBytes frame = float_frame(n, n);
    const std::uint64_t before = p.packer.encodings();
    for (std::size_t v = 0; v < viewers.size(); ++v)
      if (random() % (1 + v) == 0) viewers[v].receive(p.packer, frame);
    CHECK(p.packer.encodings() - before <= FramePacker::kMostEncodings + 1);
    CHECK(p.packer.kept_frames() <= FramePacker::kKeptFrames);
  }
}

TEST_CASE("a reference older than 8 ticks, a jump, a reset and a new mesh each make a key") {
  Packing p;
  Receiver viewer;
  viewer.receive(p.packer, float_frame(1, 100));
  viewer.receive(p.packer, float_frame(2, 108));
  CHECK_FALSE(viewer.key());
  viewer.receive(p.packer, float_frame(3, 117));
  CHECK(viewer.key());
  viewer.receive(p.packer, float_frame(4, 118, 0, proto::kFrameKey | proto::kFrameJump));
  CHECK(viewer.key());
  viewer.receive(p.packer, float_frame(5, 118));  // the same tick again, as in a pause
  CHECK_FALSE(viewer.key());
  viewer.receive(p.packer, float_frame(6, 0));
  CHECK(viewer.key());
  viewer.receive(p.packer, float_frame(7, 1));
  CHECK_FALSE(viewer.key());
  p.packer.begin(packed_mesh(2));
  viewer.decoder.begin(*packed_mesh(2).order);
  viewer.receive(p.packer, float_frame(8, 2, 0, proto::kFrameKey, 2));
  CHECK(viewer.key());
}

TEST_CASE("a cloth that travels far gets new lattices, and float32 where no bound can be kept") {
  Packing p;
  Receiver fine(1e-5);
  std::uint32_t n = 0;
  int keys = 0;
  for (float away = 0; away < 60; away += 0.25F) {
    ++n;
    fine.receive(p.packer, float_frame(n, n, away));
    CHECK(fine.packed());
    keys += fine.key() ? 1 : 0;
  }
  CHECK(keys > 2);
  CHECK(keys < 12);
  fine.receive(p.packer, float_frame(n + 1, n + 1, 5000));
  CHECK_FALSE(fine.packed());
  fine.receive(p.packer, float_frame(n + 2, n + 2, 1));
  CHECK(fine.packed());
  CHECK(fine.key());
}

TEST_CASE("what an advance observed goes as it is, and packed frames do not notice") {
  Packing p;
  Receiver viewer;
  viewer.receive(p.packer, float_frame(1, 1));
  viewer.receive(p.packer, float_frame(2, 2));
  const SharedBytes observed = float_frame(3, 3, 0, proto::kFrameKey | proto::kFrameObserved);
  viewer.receive(p.packer, observed);
  CHECK_FALSE(viewer.packed());
  CHECK(std::ranges::equal(bytes_of(viewer.message), bytes_of(observed)));
  viewer.receive(p.packer, float_frame(4, 4));
  CHECK(viewer.packed());
  CHECK(viewer.last.header.reference == 2);
}

TEST_CASE("frames of another mesh go as they are") {
  Packing p;
  Receiver viewer;
  viewer.receive(p.packer, float_frame(1, 1, 0, proto::kFrameKey, 7));
  CHECK_FALSE(viewer.packed());
  FramePacker empty;
  viewer.receive(empty, float_frame(2, 2));
  CHECK_FALSE(viewer.packed());
}

/// A hub with a viewer past its welcome.
struct OneHub {
  OneHub() {
    stream.channel = &hub.add(1, stream);
    hub.welcome_done(1);
    hub.offer_mesh(5, SharedBytes(std::string("mesh")), packed_mesh());
  }
  void pass(std::uint32_t sequence) {
    fake.now += 1.0 / 60;
    hub.offer_frame({float_frame(sequence, sequence), sequence});
    stream.drain();
    stream.channel->on_acknowledged(sequence);
  }
  int codec_of_last() const { return stream.written.back()[2]; }

  FakeClock fake;
  Metrics metrics;
  Hub hub{fake.clock(), 60, {}, metrics};
  FakeStream stream;
};

TEST_CASE("nothing is packed that no viewer wants, and float32 is as it was") {
  OneHub h;
  for (std::uint32_t n = 1; n < 5; ++n) h.pass(n);
  CHECK(h.hub.packer().encodings() == 0);
  CHECK(h.codec_of_last() == 0);
  h.hub.want_packed(1, 1e-4, 1e-4);
  for (std::uint32_t n = 5; n < 10; ++n) h.pass(n);
  CHECK(h.codec_of_last() == 2);
  CHECK(h.hub.packer().encodings() == 5);
  h.hub.want_packed(1, 0, 0);
  CHECK(h.hub.packer().kept_frames() == 0);
  h.pass(10);
  CHECK(h.codec_of_last() == 0);
  CHECK(h.hub.packer().encodings() == 5);
}

TEST_CASE(
    "frames that must arrive are packed in their turn, and a dropped one is built on by none") {
  OneHub h;
  h.hub.want_packed(1, 1e-4, 1e-4);
  Receiver viewer;
  const auto read = [&](std::size_t from) {
    for (std::size_t i = from; i < h.stream.written.size(); ++i)
      CHECK(viewer.decoder.decode(std::as_bytes(std::span(h.stream.written[i]))).has_value());
    return h.stream.written.size();
  };
  std::size_t seen = 0;
  for (std::uint32_t n = 1; n < 100; n += 10) {
    h.pass(n);
    // Offered while another is being written, and replaced before it is sent.
    h.hub.send(1, {float_frame(n + 1, n + 1), true, Topic::frame});
    h.fake.now += 1;
    h.hub.offer_frame({float_frame(n + 2, n + 2), n + 2});
    h.hub.offer_frame({float_frame(n + 3, n + 3), n + 3});
    h.stream.drain();
    h.stream.channel->on_acknowledged(n + 3);
    seen = read(seen);
  }
  CHECK(seen == 30);
}

}  // namespace
}  // namespace weft::server
