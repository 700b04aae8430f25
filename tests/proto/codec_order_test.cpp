#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "proto/codec/order.h"

using namespace weft::proto::codec;

namespace {

struct Sheet {
  std::vector<float> rest;
  std::vector<std::uint32_t> triangles;
};

/// Sheets of so many rows and columns side by side, with diagonals and numbers drawn at random.
Sheet sheets(std::mt19937& random, std::uint32_t rows, std::uint32_t columns, std::uint32_t count) {
  const std::uint32_t each = rows * columns, all = each * count;
  std::vector<std::uint32_t> names(all);
  std::iota(names.begin(), names.end(), 0U);
  std::shuffle(names.begin(), names.end(), random);
  Sheet sheet{std::vector<float>(3 * std::size_t{all}), {}};
  for (std::uint32_t i = 0; i < all; ++i) {
    const std::uint32_t k = i % each, x = k % columns, y = k / columns;
    float* const at = &sheet.rest[3 * std::size_t{names[i]}];
    at[0] = 0.1F * static_cast<float>(x);
    at[1] = 0.1F * static_cast<float>(y);
    at[2] = static_cast<float>(i / each);
    if (x + 1 == columns || y + 1 == rows) continue;
    const std::uint32_t a = names[i], b = names[i + 1], c = names[i + columns],
                        d = names[i + columns + 1];
    if (random() % 2 == 0)
      sheet.triangles.insert(sheet.triangles.end(), {a, c, b, b, c, d});
    else
      sheet.triangles.insert(sheet.triangles.end(), {a, c, d, a, d, b});
  }
  return sheet;
}

/// Each vertex once, and each neighbour before.
void check_order(const CodingOrder& order) {
  std::vector<bool> taken(order.size(), false);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    REQUIRE(order.vertices[i] < order.size());
    CHECK_FALSE(taken[order.vertices[i]]);
    taken[order.vertices[i]] = true;
    const Neighbours& near = order.neighbours[i];
    for (const std::uint32_t place : {near.a, near.b, near.c})
      CHECK((place < i || place == order.size()));
  }
}

}  // namespace

TEST_CASE("Any mesh has an order with each vertex once and each neighbour before") {
  std::mt19937 random(2);
  for (const std::uint32_t components : {1U, 2U, 5U}) {
    Sheet sheet = sheets(random, 7, 9, components);
    const auto vertices = static_cast<std::uint32_t>(sheet.rest.size() / 3);
    // Triangles without area, twice the same, and three around one edge.
    sheet.triangles.insert(sheet.triangles.end(), {0, 0, 1, 2, 2, 2, 0, 1, 2, 0, 1, 2, 0, 1, 3});
    const auto triangles = static_cast<std::uint32_t>(sheet.triangles.size() / 3);
    const ClothRange cloth{0, vertices, 0, triangles, 0, 0};
    check_order(make_order(sheet.rest, sheet.triangles, {&cloth, 1}));
  }
  const ClothRange dust{0, 4, 0, 0, 0, 0};  // without a triangle
  check_order(make_order(std::vector<float>(12), {}, {&dust, 1}));
  check_order(make_order({}, {}, {}));
}

TEST_CASE("In a sheet of random diagonals nearly every vertex closes a parallelogram at rest") {
  std::mt19937 random(4);
  const Sheet sheet = sheets(random, 40, 40, 1);
  const auto triangles = static_cast<std::uint32_t>(sheet.triangles.size() / 3);
  const ClothRange cloth{0, 1600, 0, triangles, 0, 0};
  const CodingOrder order = make_order(sheet.rest, sheet.triangles, {&cloth, 1});
  int closed = 0;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const Neighbours& near = order.neighbours[i];
    if (near.c == order.size()) continue;
    const auto x = [&](std::uint32_t place, std::size_t k) {
      return static_cast<double>(sheet.rest[3 * std::size_t{order.vertices[place]} + k]);
    };
    double gap = 0;
    for (std::size_t k = 0; k < 3; ++k)
      gap += std::abs(x(i, k) - x(near.a, k) - x(near.b, k) + x(near.c, k));
    closed += gap < 1e-6 ? 1 : 0;
  }
  CHECK(closed > 1300);
}

TEST_CASE("Grids and meshes stand side by side, and a grid alone in its natural order") {
  std::mt19937 random(6);
  Sheet sheet = sheets(random, 5, 5, 1);
  const auto triangles = static_cast<std::uint32_t>(sheet.triangles.size() / 3);
  sheet.rest.resize(3 * std::size_t{25 + 12});
  const std::vector<ClothRange> cloths = {{0, 25, 0, triangles, 0, 0},
                                          {25, 12, triangles, 0, 3, 4}};
  CHECK_FALSE(all_grids(cloths));
  const CodingOrder order = make_order(sheet.rest, sheet.triangles, cloths);
  check_order(order);
  CHECK_FALSE(order.natural);
  CHECK(order.neighbours[25 + 5] == Neighbours{25 + 4, 25 + 1, 25 + 0});
  CHECK(order.neighbours[25 + 4] == Neighbours{25, 37, 37});
  const ClothRange grid{0, 12, 0, 0, 3, 4};
  CHECK(all_grids({&grid, 1}));
  CHECK(make_order(std::vector<float>(36), {}, {&grid, 1}).natural);
}

TEST_CASE("An order survives the wire, and one that is none is refused") {
  std::mt19937 random(8);
  const Sheet sheet = sheets(random, 6, 6, 2);
  const auto triangles = static_cast<std::uint32_t>(sheet.triangles.size() / 3);
  const ClothRange cloth{0, 72, 0, triangles, 0, 0};
  const CodingOrder order = make_order(sheet.rest, sheet.triangles, {&cloth, 1});
  const std::vector<std::uint32_t> words = order_words(order);
  const auto read = read_order(words, 72);
  REQUIRE(read.has_value());
  CHECK(*read == order);
  CHECK_FALSE(read_order(words, 71).has_value());
  const auto broken = [&](std::size_t at, std::uint32_t word) {
    std::vector<std::uint32_t> changed = words;
    changed[at] = word;
    return !read_order(changed, 72).has_value();
  };
  CHECK(broken(0, 72));
  CHECK(broken(4, words[0]));  // a vertex twice
  CHECK(broken(4 * 10 + 1, 10));
  CHECK(broken(4 * 10 + 3, 0xfffffffe));
}
