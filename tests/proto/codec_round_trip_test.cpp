#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "proto/frames/packed_frame.h"

// Scenes of any cloths in any motion, coded and decoded as between a server and its viewer.

using namespace weft::proto;
using namespace weft::proto::codec;

namespace {

using Random = std::mt19937;

struct Scene {
  std::vector<ClothRange> cloths;
  std::vector<std::uint32_t> triangles;
  std::uint32_t vertices = 0;
};

void add_grid(Scene& scene, std::uint32_t rows, std::uint32_t columns) {
  const auto first = static_cast<std::uint32_t>(scene.triangles.size() / 3);
  scene.cloths.push_back({scene.vertices, rows * columns, first, 0, rows, columns});
  scene.vertices += rows * columns;
}

/// A cloth of triangles between vertices drawn at random: twice the same, of no area, many around
/// an edge, vertices of none.
void add_soup(Scene& scene, Random& random, std::uint32_t vertices, std::uint32_t triangles) {
  const auto first = static_cast<std::uint32_t>(scene.triangles.size() / 3);
  scene.cloths.push_back({scene.vertices, vertices, first, triangles, 0, 0});
  for (std::uint32_t i = 0; i < 3 * triangles; ++i)
    scene.triangles.push_back(scene.vertices + static_cast<std::uint32_t>(random() % vertices));
  scene.vertices += vertices;
}

Scene drawn_scene(Random& random) {
  Scene scene;
  for (std::uint32_t cloths = 1 + static_cast<std::uint32_t>(random() % 4); cloths > 0; --cloths) {
    const auto n = 1 + static_cast<std::uint32_t>(random() % 40);
    if (random() % 3 == 0)
      add_grid(scene, n, 1 + static_cast<std::uint32_t>(random() % 9));
    else
      add_soup(scene, random, n, static_cast<std::uint32_t>(random() % (3 * n)));
  }
  return scene;
}

/// Where a motion happens and how far it goes in a tick [m].
struct Place {
  double centre, size, step;
};

/// Sends frames of a random walk in which ticks are skipped; checks that each arrives within the
/// bound. Returns how many could be packed.
int walk(Random& random, const Scene& scene, const Place& place, double error, int frames) {
  const auto draw = [&random](double size) {
    return size * std::uniform_real_distribution<double>(-1, 1)(random);
  };
  std::vector<float> now(3 * std::size_t{scene.vertices});
  for (float& x : now) x = static_cast<float>(place.centre + draw(place.size));
  const CodingOrder order = make_order(now, scene.triangles, scene.cloths);
  const Result<CodingOrder> told = read_order(order_words(order), scene.vertices);
  REQUIRE(told.has_value());
  PayloadEncoder encoder;
  FrameDecoder decoder;
  decoder.begin(*told);
  std::array<Integers, 3> held;
  std::optional<Lattice> lattice;
  int since_key = 0, packed = 0;
  for (int n = 0; n < frames; ++n) {
    for (float& x : now)
      if (random() % 4 != 0) x = static_cast<float>(static_cast<double>(x) + draw(place.step));
    const Bounds bounds = bounds_of(now);
    const bool key = n == 0 || !lattice || !holds(*lattice, bounds) || random() % 16 == 0;
    if (key) lattice = make_lattice(bounds, error, 0);
    if (!lattice) continue;
    since_key = key ? 0 : since_key + 1;
    const auto slot = [n](int ago) { return static_cast<std::size_t>((n - ago + 3) % 3); };
    quantise(*lattice, now, order.vertices, held[slot(0)]);
    const auto sequence = static_cast<std::uint32_t>(n);
    PackRequest request;
    if (since_key > 0) request.references.last = &held[slot(1)];
    if (since_key > 1) request.references.before = &held[slot(2)], request.before = sequence - 2;
    FrameHeader header;
    header.sequence = header.reference = sequence;
    Bytes plain;
    encode_frame({header, now, {}, {}, {}, {}, {}}, plain);
    const Result<Frame> frame =
        decoder.decode(pack_frame(plain, {key ? sequence : sequence - 1, lattice->step},
                                  encoder.encode(order, *lattice, held[slot(0)], request)));
    REQUIRE(frame.has_value());
    double worst = 0;
    for (std::size_t i = 0; i < now.size(); i += 3) {
      double square = 0;
      for (std::size_t c = i; c < i + 3; ++c)
        square +=
            std::pow(static_cast<double>(now[c]) - static_cast<double>(frame->positions[c]), 2);
      worst = std::max(worst, std::sqrt(square));
    }
    CHECK(worst <= error);
    ++packed;
  }
  return packed;
}

}  // namespace

TEST_CASE("Any cloths in any motion arrive within the bound") {
  Random random(21);
  int packed = 0;
  for (int round = 0; round < 200; ++round) {
    const Scene scene = drawn_scene(random);
    const double size = std::pow(10.0, -4 + static_cast<double>(random() % 6));
    const Place place{random() % 2 == 0 ? 0.0 : 5.0, size,
                      size * std::pow(10.0, -static_cast<double>(random() % 7))};
    packed += walk(random, scene, place, random() % 2 == 0 ? 1e-4 : 1e-5, 12);
  }
  CHECK(packed > 2000);
}

TEST_CASE("The least and the large scenes arrive within the bound") {
  Random random(22);
  Scene vertex, triangle, large;
  add_grid(vertex, 1, 1);
  triangle.cloths.push_back({0, 3, 0, 1, 0, 0});
  triangle.triangles = {0, 1, 2};
  triangle.vertices = 3;
  add_grid(large, 128, 128);
  add_soup(large, random, 5000, 9000);
  for (const double error : {1e-4, 1e-5}) {
    for (const Scene* scene : {&vertex, &triangle})
      CHECK(walk(random, *scene, {0, 1, 0.01}, error, 40) == 40);
    CHECK(walk(random, large, {0, 1, 0.01}, error, 6) == 6);
  }
}

TEST_CASE("A kilometre away a tenth of a millimetre is kept or no frame is packed") {
  Random random(23);
  Scene scene;
  add_grid(scene, 5, 7);
  int packed = 0;
  for (const double centre : {50.0, 100.0, 300.0, 511.0, 700.0, 1000.0, -1000.0, 1e6, 1e30})
    packed += walk(random, scene, {centre, 1, 0.01}, 1e-4, 10);
  CHECK(packed >= 30);  // as far as floats are fine enough
}
