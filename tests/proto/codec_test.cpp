#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "proto/frames/mesh.h"
#include "proto/frames/packed_frame.h"
#include "tests/proto/golden.h"
#include "tests/proto/guarded_bytes.h"
#include "tests/proto/packed_streams.h"

using namespace weft::proto;
using namespace weft::proto::codec;
using namespace weft::test;
using nlohmann::json;

namespace {

bool same_bits(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  });
}

/// Largest distance between positions and what is shown of them [m].
double largest_error(std::span<const float> a, std::span<const float> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double gap = static_cast<double>(a[i + c]) - static_cast<double>(b[i + c]);
      square += gap * gap;
    }
    largest = std::max(largest, std::sqrt(square));
  }
  return largest;
}

Bytes float_frame(std::uint32_t sequence, std::span<const float> positions) {
  Bytes bytes;
  FrameHeader header;
  header.sequence = header.reference = sequence;
  encode_frame({header, positions, {}, {}, {}, {}, {}}, bytes);
  return bytes;
}

CodingOrder order_of_grid(std::uint32_t rows, std::uint32_t columns) {
  const ClothRange cloth{0, rows * columns, 0, 0, rows, columns};
  const std::vector<float> rest(3 * std::size_t{rows} * columns);
  return make_order(rest, {}, {&cloth, 1});
}

/// Positions that are hard: noise of a size at places of another size.
std::vector<float> scattered(std::mt19937& random, std::size_t vertices, double centre,
                             double size) {
  std::uniform_real_distribution<double> draw(-size, size);
  std::vector<float> positions(3 * vertices);
  for (float& x : positions) x = static_cast<float>(centre + draw(random));
  return positions;
}

}  // namespace

TEST_CASE("Packed golden frames are read bit for bit") {
  for_each_packed_stream([](const PackedStream& stream) {
    FrameDecoder decoder;
    decoder.begin(stream.order);
    for (const auto& [packed, plain] : stream.frames) {
      const Result<Frame> frame = decoder.decode(GuardedBytes(packed).view());
      const Result<Frame> expected = decode_frame(plain);
      REQUIRE(frame.has_value());
      REQUIRE(expected.has_value());
      CHECK(same_bits(frame->positions, expected->positions));
      CHECK(frame->grabs == expected->grabs);
      CHECK(frame->applied == expected->applied);
      CHECK(frame->header.sequence == expected->header.sequence);
    }
  });
}

TEST_CASE("The encoder writes the bytes of the golden frames") {
  for_each_packed_stream([](const PackedStream& stream) {
    PayloadEncoder encoder;
    std::array<Integers, 3> held;
    std::array<std::uint32_t, 3> sequences{};
    Lattice lattice;
    std::size_t since_key = 0, n = 0;
    for (const auto& [packed, plain] : stream.frames) {
      const Result<FrameParts> parts = read_frame(packed);
      REQUIRE(parts.has_value());
      const std::uint32_t sequence = parts->frame.header.sequence;
      const bool key = parts->frame.header.reference == sequence;
      const Result<PayloadHeader> header = read_payload_header(parts->packed, key);
      REQUIRE(header.has_value());
      since_key = key ? 0 : since_key + 1;
      if (key) lattice = {header->origin, parts->step, 0};
      PackRequest request;
      request.prediction = header->prediction;
      if (since_key > 0) request.references.last = &held[(n + 2) % 3];
      if (since_key > 1) request.references.before = &held[(n + 1) % 3];
      request.before = sequences[(n + 1) % 3];
      quantise(lattice, decode_frame(plain)->positions, stream.order.vertices, held[n % 3]);
      sequences[n % 3] = sequence;
      const Bytes payload = encoder.encode(stream.order, lattice, held[n % 3], request);
      CHECK(pack_frame(plain, {parts->frame.header.reference, lattice.step}, payload) == packed);
      ++n;
    }
  });
}

TEST_CASE("Each packed frame that breaks a rule is refused, and changes nothing") {
  const PackedStream stream = packed_stream("packed_2x2");
  const json goldens = read_golden_json("packed.json");
  for (const json& golden : goldens["refused"]) {
    INFO(golden["rule"]);
    FrameDecoder decoder;
    decoder.begin(stream.order);
    std::size_t n = 0;
    for (; n < golden["after"]; ++n) REQUIRE(decoder.decode(stream.frames[n].first).has_value());
    const Bytes bad = bytes_of_hex(golden["hex"]);
    CHECK_FALSE(decoder.decode(GuardedBytes(bad).view()).has_value());
    CHECK_FALSE(decode_frame(bad).has_value());
    for (; n < stream.frames.size(); ++n) CHECK(decoder.decode(stream.frames[n].first).has_value());
  }
}

TEST_CASE("No vertex is shown further off than the bound, however hard the positions") {
  std::mt19937 random(11);
  const CodingOrder order = order_of_grid(16, 16);
  for (const double error : {1e-4, 1e-5}) {
    std::size_t packed = 0;
    for (const double centre : {0.0, 0.3, -7.7, 15.99, 40.0, 63.0, -100.0, 1000.0})
      for (const double size : {1e-6, 1e-3, 0.5, 3.0, 8.9, 60.0}) {
        const std::vector<float> positions = scattered(random, 256, centre, size);
        const Bounds bounds = bounds_of(positions);
        const auto lattice = make_lattice(bounds, error, 0);
        if (!lattice) continue;
        CHECK(holds(*lattice, bounds));
        Integers integers;
        quantise(*lattice, positions, order.vertices, integers);
        std::vector<float> shown(positions.size());
        positions_of(*lattice, integers, order.vertices, shown);
        CHECK(largest_error(positions, shown) <= error);
        ++packed;
      }
    CHECK(packed > 15);
  }
}

TEST_CASE("A lattice is refused where floats or 2^20 steps cannot keep the bound") {
  CHECK_FALSE(make_lattice({{0, 0, 0}, {30, 0, 0}}, 1e-5, 0));  // 12 m to either side
  CHECK(make_lattice({{0, 0, 0}, {30, 0, 0}}, 1e-4, 0));
  CHECK_FALSE(make_lattice({{500, 0, 0}, {501, 0, 0}}, 1e-5, 0));  // floats are 30 um apart
  CHECK_FALSE(make_lattice({{-1e9F, 0, 0}, {1e9F, 0, 0}}, 1e-4, 0));
  const auto lattice = make_lattice({{0, 0, 0}, {1, 1, 1}}, 1e-5, 0);
  REQUIRE(lattice);
  CHECK_FALSE(holds(*lattice, {{0, 0, 0}, {1, 1, 3}}));  // beyond its reach
}

TEST_CASE("Positions of which one coordinate is no finite number have no lattice") {
  std::mt19937 random(12);
  const std::vector<float> positions = scattered(random, 9, 0.5, 1);
  const auto lattice = make_lattice(bounds_of(positions), 1e-4, 0);
  REQUIRE(lattice);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::nanf("1"),
        std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()})
    for (std::size_t i = 0; i < positions.size(); ++i) {
      std::vector<float> broken = positions;
      broken[i] = bad;
      const Bounds bounds = bounds_of(broken);
      CHECK_FALSE(make_lattice(bounds, 1e-4, 0));
      CHECK_FALSE(holds(*lattice, bounds));
    }
  std::vector<float> large = positions;
  large[4] = std::numeric_limits<float>::max();
  CHECK(std::isfinite(bounds_of(large).high[1]));
}

TEST_CASE("A stream is exact in any order of predictions, over any ages of references") {
  std::mt19937 random(5);
  for (const auto& [rows, columns] : {std::pair{1U, 1U}, {1U, 17U}, {17U, 1U}, {12U, 31U}}) {
    const CodingOrder order = order_of_grid(rows, columns);
    const Lattice lattice{{0.5, 0, -2}, 1.1e-4F, 8};
    PayloadEncoder encoder;
    FrameDecoder decoder;
    decoder.begin(order);
    std::array<Integers, 3> held;
    for (std::uint32_t n = 0; n < 60; ++n) {
      const std::uint32_t spread = 1U << (random() % 21);
      Integers& now = held[n % 3];
      now.resize(order.size());
      for (int c = 0; c < 3; ++c)
        for (std::uint32_t i = 0; i < order.size(); ++i)
          now.plane(c)[i] = static_cast<std::int32_t>(random() % (2 * spread)) -
                            static_cast<std::int32_t>(spread) + 1;
      PackRequest request;
      const bool key = n % 20 == 0;
      if (!key) request.references.last = &held[(n + 2) % 3];
      if (n % 20 > 1) request.references.before = &held[(n + 1) % 3];
      request.before = 100 + n - 2;
      if (n % 3 > 0)
        request.prediction = Prediction{static_cast<Base>(random() % (1 + std::min(n % 20, 2U))),
                                        static_cast<Spatial>(random() % 4)};
      const Bytes payload = encoder.encode(order, lattice, now, request);
      std::vector<float> shown(3 * std::size_t{order.size()});
      positions_of(lattice, now, order.vertices, shown);
      const Bytes plain = float_frame(100 + n, shown);
      const Bytes packed = pack_frame(plain, {key ? 100 + n : 99 + n, lattice.step}, payload);
      const Result<Frame> frame = decoder.decode(packed);
      REQUIRE(frame.has_value());
      CHECK(same_bits(frame->positions, shown));
    }
  }
}

TEST_CASE("A frame whose reference was lost is refused until the next key") {
  const PackedStream stream = packed_stream("packed_predictions");
  const json goldens = read_golden_json("packed.json");
  for (std::size_t lost = 1; lost < stream.frames.size(); ++lost) {
    FrameDecoder decoder;
    decoder.begin(stream.order);
    bool missing = false;
    for (std::size_t n = 0; n < stream.frames.size(); ++n) {
      const json& golden = goldens["packed_predictions"]["frames"][n];
      if (golden["key"]) missing = false;
      if (n == lost) missing = true;
      if (n == lost) continue;
      const Result<Frame> frame = decoder.decode(stream.frames[n].first);
      CHECK(frame.has_value() == !missing);
      if (frame)
        CHECK(same_bits(frame->positions, decode_frame(stream.frames[n].second)->positions));
    }
  }
}

TEST_CASE("A float32 frame between packed ones changes nothing for them") {
  const PackedStream stream = packed_stream("packed_predictions");
  FrameDecoder decoder;
  decoder.begin(stream.order);
  for (const auto& [packed, plain] : stream.frames) {
    CHECK(decoder.decode(plain).has_value());
    CHECK(decoder.decode(packed).has_value());
  }
}

TEST_CASE("Frequencies add up to 4096, and every token that occurs has one") {
  std::mt19937 random(3);
  for (int round = 0; round < 3000; ++round) {
    std::array<std::uint32_t, 64> counts{};
    const auto draw = [&random](std::uint32_t end) {
      return static_cast<std::uint32_t>(random() % end);
    };
    const std::uint32_t kinds = 1 + draw(kTokens);
    for (std::uint32_t k = 0; k < kinds; ++k)
      counts[draw(kTokens)] = 1 + (draw(5) == 0 ? draw(1000000) : draw(3));
    const TokenTable table = normalise(counts);
    CHECK(std::accumulate(table.frequencies.begin(), table.frequencies.end(), 0U) == kFrequencySum);
    for (std::uint32_t t = 0; t < kTokens; ++t)
      CHECK((counts[t] > 0) == (table.frequencies[t] > 0));
  }
}
