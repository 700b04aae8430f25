#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "proto/codec/payload.h"

// Which prediction the encoder takes, beside all that it could have taken.

using namespace weft::proto::codec;

namespace {

constexpr std::uint32_t kSide = 64;
// Of a frame in which next to nothing is left [bytes].
constexpr double kSmall = 16;
constexpr Lattice kLattice{{0, 0, 0}, 1.1e-4F, 8};

/// How a sheet moves: waves of an amplitude [m] that run on by an angle each tick, while the whole
/// falls; and noise of single vertices [m].
struct Motion {
  const char* name;
  double amplitude, turn, fall, noise;
};
constexpr std::array kMotions = {
    Motion{"at rest", 0.05, 0, 0, 0},          Motion{"at rest with noise", 0.05, 0, 0, 1e-4},
    Motion{"slow waves", 0.05, 0.002, 0, 0},   Motion{"fast waves", 0.05, 0.2, 0, 0},
    Motion{"violent waves", 0.2, 1.5, 0, 0},   Motion{"a steady fall", 0.05, 0, 0.02, 0},
    Motion{"noisy waves", 0.05, 0.1, 0, 2e-4},
};

Integers sheet_at(const Motion& motion, int tick) {
  std::vector<float> positions;
  std::vector<std::uint32_t> vertices;
  std::mt19937 random(static_cast<unsigned>(tick));
  const auto noise = [&] { return motion.noise * static_cast<double>(random()) * 0x1p-32; };
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const double u = 0.02 * (i % kSide), v = 0.02 * (i / kSide), phase = motion.turn * tick;
    const double z = motion.amplitude * std::sin(7 * u + 3 * v + phase);
    const double y = -v - motion.fall * tick + 0.3 * motion.amplitude * std::cos(5 * v - phase);
    for (const double x : {u, y, z}) positions.push_back(static_cast<float>(x + noise()));
    vertices.push_back(i);
  }
  Integers integers;
  quantise(kLattice, positions, vertices, integers);
  return integers;
}

std::size_t bytes_of(const CodingOrder& order, const Integers& now, PackRequest request,
                     std::optional<Prediction> prediction) {
  request.prediction = prediction;
  return PayloadEncoder().encode(order, kLattice, now, request).size();
}

/// The least size over all predictions that the references allow.
std::size_t least_bytes(const CodingOrder& order, const Integers& now, const PackRequest& request) {
  const int bases = request.references.before ? 3 : request.references.last ? 2 : 1;
  std::size_t least = SIZE_MAX;
  for (int base = 0; base < bases; ++base)
    for (int spatial = 0; spatial < 4; ++spatial)
      least = std::min(
          least, bytes_of(order, now, request,
                          Prediction{static_cast<Base>(base), static_cast<Spatial>(spatial)}));
  return least;
}

}  // namespace

TEST_CASE("The prediction chosen by a sample costs at most a twentieth more than the best of all") {
  const ClothRange cloth{0, kSide * kSide, 0, 0, kSide, kSide};
  const CodingOrder order =
      make_order(std::vector<float>(3 * std::size_t{kSide} * kSide), {}, {&cloth, 1});
  for (const Motion& motion : kMotions)
    for (const int age : {1, 4, 8}) {
      INFO(motion.name << ", references " << age << " ticks old");
      const Integers before = sheet_at(motion, 0), last = sheet_at(motion, age),
                     now = sheet_at(motion, 2 * age);
      PackRequest request;
      for (const Integers* second : {static_cast<const Integers*>(nullptr), &before}) {
        request.references = {&last, second};
        const auto chosen = static_cast<double>(bytes_of(order, now, request, {}));
        CHECK(chosen <= kSmall + 1.05 * static_cast<double>(least_bytes(order, now, request)));
      }
    }
}
