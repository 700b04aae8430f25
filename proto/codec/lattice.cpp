#include "proto/codec/lattice.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace weft::proto::codec {
namespace {

// Rounding to float moves a coordinate below a power of two by at most 2^-25 of that.
constexpr double kRounding = 0x1p-25;
// Of the reach: coordinates end so far below it that their errors do not lead beyond.
constexpr double kInside = 0.999;
// Of the step: more than what double arithmetic adds to the error, and its own rounding.
constexpr double kSlack = 1 - 1e-9;
// A new lattice has room to move, so that a cloth that travels changes it seldom.
constexpr double kFilled = 0.75;
constexpr double kRoomToGrow = 1.5;
// Doubles of this size have their last bit at 1: adding it rounds to the nearest whole number, with
// ties to even, in the same way on every machine.
constexpr double kRounder = 0x1.8p52;

float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) <= value ? nearest : std::nextafter(nearest, 0.0F);
}

double largest_coordinate(const Bounds& bounds) {
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    largest = std::max({largest, std::abs(static_cast<double>(bounds.low[c])),
                        std::abs(static_cast<double>(bounds.high[c]))});
  return largest;
}

double power_of_two_above(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, exponent);
}

/// Whether all are finite numbers. Adding to an exponent that is all ones overflows into the sign.
bool are_finite(std::span<const float> values) {
  std::uint32_t overflow = 0;
  for (const float x : values)
    overflow |= (std::bit_cast<std::uint32_t>(x) & 0x7f800000U) + 0x00800000U;
  return overflow >> 31U == 0;
}

/// How far rounding to float moves a point whose coordinates are below a power of two [m].
double rounding_at(double reach) {
  return std::sqrt(3.0) * kRounding * reach;
}

/// Most steps that a coordinate of these bounds is away from the origin.
double most_steps(const Lattice& lattice, const Bounds& bounds) {
  double most = 0;
  for (std::size_t c = 0; c < 3; ++c)
    most = std::max({most, lattice.origin[c] - static_cast<double>(bounds.low[c]),
                     static_cast<double>(bounds.high[c]) - lattice.origin[c]});
  return most / static_cast<double>(lattice.step);
}

}  // namespace

void Integers::resize(std::uint32_t vertices) {
  count = vertices;
  values.assign(3 * (std::size_t{vertices} + 1), 0);
}

Bounds bounds_of(std::span<const float> positions) {
  if (positions.empty()) return {};
  Bounds bounds;
  constexpr float kFar = std::numeric_limits<float>::infinity();
  bounds.low = {kFar, kFar, kFar};
  bounds.high = {-kFar, -kFar, -kFar};
  if (!are_finite(positions)) return {bounds.high, bounds.low};
  // Eight vertices at a time, as whole vectors.
  constexpr std::size_t kLanes = 24;
  std::array<float, kLanes> low, high;
  low.fill(kFar);
  high.fill(-kFar);
  const auto take = [&](const float* x, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      low[k] = x[k] < low[k] ? x[k] : low[k];
      high[k] = x[k] > high[k] ? x[k] : high[k];
    }
  };
  std::size_t i = 0;
  for (; i + kLanes <= positions.size(); i += kLanes) take(positions.data() + i, kLanes);
  take(positions.data() + i, (positions.size() - i) / 3 * 3);
  for (std::size_t k = 0; k < kLanes; ++k) {
    bounds.low[k % 3] = std::min(bounds.low[k % 3], low[k]);
    bounds.high[k % 3] = std::max(bounds.high[k % 3], high[k]);
  }
  return bounds;
}

std::optional<Lattice> make_lattice(const Bounds& bounds, double error, double least_reach) {
  assert(error > 0);
  const double largest = std::max(1.0, largest_coordinate(bounds));
  if (!std::isfinite(largest)) return std::nullopt;
  // With room to grow, or without where the rounding of large coordinates leaves none.
  double reach = power_of_two_above(std::max(kRoomToGrow * largest, least_reach));
  if (rounding_at(reach) >= error / 2) reach = power_of_two_above(largest / kInside);
  if (!(rounding_at(reach) < error / 2)) return std::nullopt;
  Lattice lattice;
  lattice.reach = reach;
  lattice.step = rounded_down(kSlack * 2 * (error - rounding_at(reach)) / std::sqrt(3.0));
  for (std::size_t c = 0; c < 3; ++c)
    lattice.origin[c] =
        (static_cast<double>(bounds.low[c]) + static_cast<double>(bounds.high[c])) / 2;
  if (most_steps(lattice, bounds) >= kFilled * kMostSteps) return std::nullopt;
  return lattice;
}

bool holds(const Lattice& lattice, const Bounds& bounds) {
  return largest_coordinate(bounds) <= kInside * lattice.reach &&
         most_steps(lattice, bounds) < kMostSteps - 1;
}

void quantise(const Lattice& lattice, std::span<const float> positions,
              std::span<const std::uint32_t> vertices, Integers& out) {
  const auto count = static_cast<std::uint32_t>(vertices.size());
  assert(positions.size() == 3 * vertices.size());
  out.resize(count);
  const double per_step = 1 / static_cast<double>(lattice.step);
  for (std::size_t c = 0; c < 3; ++c) {
    std::int32_t* const plane = out.plane(static_cast<int>(c));
    const double origin = lattice.origin[c];
    for (std::size_t i = 0; i < count; ++i) {
      const auto x = static_cast<double>(positions[3 * std::size_t{vertices[i]} + c]);
      const double rounded = (x - origin) * per_step + kRounder;
      plane[i] = static_cast<std::int32_t>(std::bit_cast<std::int64_t>(rounded));
    }
  }
}

void positions_of(const Lattice& lattice, const Integers& integers,
                  std::span<const std::uint32_t> vertices, std::span<float> out) {
  assert(out.size() == 3 * vertices.size() && integers.count == vertices.size());
  for (int c = 0; c < 3; ++c) {
    const std::int32_t* const plane = integers.plane(c);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      out[3 * std::size_t{vertices[i]} + static_cast<std::size_t>(c)] =
          static_cast<float>(lattice.coordinate(c, plane[i]));
  }
}

Sums sums_of(const Integers& integers) {
  Sums sums;
  std::uint32_t before = 0;
  for (int c = 0; c < 3; ++c) {
    const std::int32_t* const plane = integers.plane(c);
    for (std::uint32_t i = 0; i < integers.count; ++i) {
      const auto k = static_cast<std::uint32_t>(plane[i]);
      sums.a += k;
      sums.b += (before + i + 1) * k;
    }
    before += integers.count;
  }
  return sums;
}

}  // namespace weft::proto::codec
