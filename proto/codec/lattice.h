#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// Positions as whole multiples of a step, and back. README.md section 10.

namespace weft::proto::codec {

/// |k| of every coordinate stays below this, which bounds the bits of every difference.
inline constexpr std::int32_t kMostSteps = 1 << 20;

/// The points at which positions may lie.
struct Lattice {
  std::array<double, 3> origin{};  ///< [m]
  float step = 0;                  ///< [m]
  /// The bound of the error holds for coordinates up to this [m]. The encoder's own.
  double reach = 0;

  bool operator==(const Lattice&) const = default;
  double coordinate(int component, std::int32_t k) const {
    return origin[static_cast<std::size_t>(component)] +
           static_cast<double>(k) * static_cast<double>(step);
  }
};

/// The whole numbers of a frame: for each component those of all places, and a 0 for what is
/// missing.
struct Integers {
  std::vector<std::int32_t> values;
  std::uint32_t count = 0;  ///< vertices

  void resize(std::uint32_t vertices);
  std::int32_t* plane(int component) {
    return values.data() + static_cast<std::size_t>(component) * (std::size_t{count} + 1);
  }
  const std::int32_t* plane(int component) const {
    return values.data() + static_cast<std::size_t>(component) * (std::size_t{count} + 1);
  }
  bool operator==(const Integers&) const = default;
};

/// The box around positions; without end if a coordinate is no finite number, so that no lattice
/// holds them.
struct Bounds {
  std::array<float, 3> low{}, high{};
};
Bounds bounds_of(std::span<const float> positions);

/// A lattice around positions on which each is off by at most `error`, a Euclidean distance [m],
/// the final rounding to float included. Nothing if float coordinates are too coarse for that, or
/// the positions too far apart.
/// @param least_reach  a coordinate for which it shall hold in any case [m]
std::optional<Lattice> make_lattice(const Bounds& bounds, double error, double least_reach);

/// Whether positions of these bounds may be put on the lattice.
bool holds(const Lattice& lattice, const Bounds& bounds);

/// @param vertices  the vertex at each place; the lattice must hold all positions
void quantise(const Lattice& lattice, std::span<const float> positions,
              std::span<const std::uint32_t> vertices, Integers& out);

/// The float that clients show: (float)(origin + k step), computed in double.
void positions_of(const Lattice& lattice, const Integers& integers,
                  std::span<const std::uint32_t> vertices, std::span<float> out);

/// Sums over all components and places, modulo 2^32: of k, and of (place + 1) k, components
/// following each other. They tell that two sides hold the same numbers.
struct Sums {
  std::uint32_t a = 0, b = 0;
  bool operator==(const Sums&) const = default;
};
Sums sums_of(const Integers& integers);

}  // namespace weft::proto::codec
