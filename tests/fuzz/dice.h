#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace weft::fuzz {

/// Random numbers that belong to a place, e.g. a field of the second cloth. What is drawn at one
/// place depends on its name and the seed alone, so a field that the schema gains moves no other.
class Dice {
 public:
  explicit Dice(std::uint64_t key) : key_(key), state_(key) {}
  Dice(std::uint64_t seed, std::uint64_t scene) : Dice(mixed(mixed(seed) ^ scene)) {}

  /// The dice of a part of this place.
  Dice of(std::string_view part) const {
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
    for (const char letter : part)
      hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
    return Dice(mixed(key_ ^ hash));
  }
  Dice of(std::size_t part) const { return Dice(mixed(key_ + 0x51ed270b * (part + 1))); }

  /// SplitMix64 (Steele, Lea, Flood 2014).
  std::uint64_t bits() { return mixed(state_ += 0x9e3779b97f4a7c15); }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  /// Each decade is as likely as any other. @param low  above 0
  double logarithmic(double low, double high) {
    return std::clamp(std::exp(uniform(std::log(low), std::log(high))), low, high);
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// A number below `count`, which is at least 1.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits() % count); }
  /// From `least` to `most`, both included.
  int between(int least, int most) {
    return least + static_cast<int>(below(static_cast<std::size_t>(most - least) + 1));
  }

  /// A number of a range: near the usual one, anywhere, of any magnitude, or exactly an end.
  /// @param wild  probability that it is not near the usual one
  double number(double minimum, double maximum, double usual, double wild) {
    if (!chance(wild)) return near(minimum, maximum, usual);
    switch (below(4)) {
      case 0:
        return uniform(minimum, maximum);
      case 1: {
        const double most = std::max(std::abs(minimum), std::abs(maximum));
        const double least = minimum > 0 ? minimum : most * 1e-6;
        const double size = most > least ? logarithmic(least, most) : most;
        return std::clamp(minimum < 0 && chance(0.5) ? -size : size, minimum, maximum);
      }
      case 2:
        return minimum;
      default:
        return maximum;
    }
  }

  /// A unit quaternion x y z w: none, a quarter turn, or any.
  std::array<double, 4> rotation() {
    const std::size_t kind = below(4);
    if (kind == 0) return {0, 0, 0, 1};
    std::array<double, 4> q{};
    if (kind == 1) {
      q[below(3)] = chance(0.5) ? std::sqrt(0.5) : -std::sqrt(0.5);
      q[3] = std::sqrt(0.5);
      return q;
    }
    double norm2 = 0;
    for (double& each : q) {
      each = uniform(-1, 1);
      norm2 += each * each;
    }
    if (norm2 < 1e-4) return {0, 0, 0, 1};
    for (double& each : q) each /= std::sqrt(norm2);
    return q;
  }

 private:
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  double near(double minimum, double maximum, double usual) {
    if (usual != 0) return std::clamp(usual * std::exp2(uniform(-2, 2)), minimum, maximum);
    const double size = std::min(1.0, maximum);
    if (minimum < 0) return std::clamp(uniform(-size, size), minimum, maximum);
    return chance(0.3) ? minimum : std::clamp(logarithmic(1e-3 * size, size), minimum, maximum);
  }

  std::uint64_t key_, state_;
};

}  // namespace weft::fuzz
