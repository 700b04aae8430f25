#include <array>
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "proto/frames/packed_frame.h"
#include "tests/proto/golden.h"
#include "tests/proto/guarded_bytes.h"
#include "tests/proto/packed_streams.h"

// Bytes that were cut or changed, read next to an unreadable page.

using namespace weft::proto;
using namespace weft::proto::codec;
using namespace weft::test;

namespace {

constexpr std::array kSmall = {"packed_1x1", "packed_1x9", "packed_9x1", "packed_2x2"};
constexpr std::size_t kFixed = 64;  // of a frame, before its sections

/// A decoder that has read all frames of a stream before one.
FrameDecoder decoder_before(const PackedStream& stream, std::size_t frame) {
  FrameDecoder decoder;
  decoder.begin(stream.order);
  for (std::size_t n = 0; n < frame; ++n)
    REQUIRE(decoder.decode(stream.frames[n].first).has_value());
  return decoder;
}

/// Whether a message is accepted. What comes after is read as if it had never been.
class Trial {
 public:
  Trial(const PackedStream& stream, std::size_t frame)
      : before_(decoder_before(stream, frame)), stream_(stream), frame_(frame) {}

  Result<Frame> read(const Bytes& message) const {
    FrameDecoder decoder = before_;
    const GuardedBytes guarded(message);
    Result<Frame> frame = decoder.decode(guarded.view());
    if (!frame) CHECK(decoder.decode(stream_.frames[frame_].first).has_value());
    return frame;
  }

 private:
  FrameDecoder before_;
  const PackedStream& stream_;
  std::size_t frame_;
};

Bytes first_bytes(const Bytes& message, std::size_t length) {
  return {message.begin(), message.begin() + static_cast<std::ptrdiff_t>(length)};
}

Bytes flipped(Bytes message, std::size_t bit) {
  message[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
  return message;
}

template <class Visit>
void for_each_frame(const char* name, Visit&& visit) {
  const PackedStream stream = packed_stream(name);
  for (std::size_t n = 0; n < stream.frames.size(); ++n) {
    INFO(name << " frame " << n);
    visit(Trial(stream, n), stream.frames[n].first, stream.frames[n].second);
  }
}

}  // namespace

TEST_CASE("A packed frame cut anywhere or with a byte more is refused") {
  for (const char* name : kSmall)
    for_each_frame(name, [](const Trial& trial, const Bytes& message, const Bytes&) {
      for (std::size_t length = 0; length < message.size(); ++length) {
        CHECK_FALSE(trial.read(first_bytes(message, length)).has_value());
        CHECK_FALSE(trial.read(sealed(first_bytes(message, length))).has_value());
      }
      Bytes longer = message;
      longer.push_back(std::byte{0});
      CHECK_FALSE(trial.read(longer).has_value());
    });
}

TEST_CASE("A packed frame with any one bit flipped is refused") {
  for (const char* name : kSmall)
    for_each_frame(name, [](const Trial& trial, const Bytes& message, const Bytes&) {
      for (std::size_t bit = 0; bit < 8 * message.size(); ++bit)
        CHECK_FALSE(trial.read(flipped(message, bit)).has_value());
    });
}

// Here the checksum of the message is right again, so that the checks of the codec are met. Origin
// and step are plain numbers that no other can be told from.
TEST_CASE("Packed positions with any one bit flipped are refused even behind a right checksum") {
  std::size_t accepted = 0, refused = 0;
  for (const char* name : {"packed_2x2", "packed_9x1", "packed_extremes"})
    for_each_frame(name, [&](const Trial& trial, const Bytes& message, const Bytes& plain) {
      const auto parts = read_frame(message);
      REQUIRE(parts.has_value());
      const auto begin = static_cast<std::size_t>(parts->packed.data() - message.data());
      const std::size_t end = begin + parts->packed.size();
      const bool key = parts->frame.header.reference == parts->frame.header.sequence;
      const std::size_t stride = message.size() > 500 ? 13 : 1;
      for (std::size_t bit = 8 * begin; bit < 8 * end; bit += stride) {
        const std::size_t at = bit / 8 - begin;
        if (key && at >= 20 && at < 44) continue;
        const Result<Frame> read = trial.read(sealed(flipped(message, bit)));
        // What is accepted all the same shows the same positions: a bit that means nothing.
        if (read) CHECK(read->positions == decode_frame(plain)->positions);
        ++(read ? accepted : refused);
      }
    });
  CHECK(refused > 100 * accepted);
}

TEST_CASE("Packed bytes changed at random behind a right checksum are survived") {
  std::mt19937 random(9);
  std::size_t accepted = 0, refused = 0;
  for (const char* name : {"packed_1x9", "packed_2x2", "packed_meshes", "packed_extremes"})
    for_each_frame(name, [&](const Trial& trial, const Bytes& message, const Bytes&) {
      for (int round = 0; round < 300; ++round) {
        Bytes changed = message;
        const std::size_t first = random() % 4 == 0 ? 0 : kFixed;
        for (std::uint32_t i = 0; i <= random() % 4; ++i) {
          const std::byte value{static_cast<unsigned char>(random() % 3 ? random() % 256 : 255)};
          changed[first + random() % (changed.size() - first)] = value;
        }
        if (random() % 4 == 0) changed.resize(kFixed + random() % (changed.size() - kFixed));
        ++(trial.read(sealed(changed)).has_value() ? accepted : refused);
      }
    });
  CHECK(accepted + refused > 9000);
  CHECK(refused > accepted);
}
