// Validates and evaluates scheduled events.

#include "core/world/script.h"

#include <cassert>

#include "core/error.h"

namespace weft {

void validate(const HandDef& def, const std::string& path) {
  visit_fields_of_hand(
      def, [&path](const FieldInfo& info, const auto& value) { check_field(path, info, value); });
  check_field(path, {"path", 1, kMostHandKeys, "", "number of its keys"},
              static_cast<double>(def.path.size()));
  for (std::size_t k = 0; k < def.path.size(); ++k) {
    const std::string at = path + "path[" + std::to_string(k) + "].";
    visit_fields_of_hand_key(def.path[k], [&at](const FieldInfo& info, const auto& value) {
      check_field(at, info, value);
    });
    if (k > 0 && !(def.path[k].time > def.path[k - 1].time))
      throw DefinitionError(at + "time", number_text(def.path[k].time),
                            "more than that of the key before");
  }
}

void validate(const DisturbanceDef& def, const std::string& path) {
  visit_fields_of_disturbance(
      def, [&path](const FieldInfo& info, const auto& value) { check_field(path, info, value); });
}

void validate(const std::vector<WindKey>& winds) {
  check_field("", {"winds", 0, kMostWinds, "", "number of winds"},
              static_cast<double>(winds.size()));
  for (std::size_t k = 0; k < winds.size(); ++k) {
    const std::string at = "winds[" + std::to_string(k) + "].";
    visit_fields_of_wind_key(winds[k], [&at](const FieldInfo& info, const auto& value) {
      check_field(at, info, value);
    });
    if (k > 0 && !(winds[k].time > winds[k - 1].time))
      throw DefinitionError(at + "time", number_text(winds[k].time),
                            "more than that of the wind before");
  }
}

Vec3d offset_at(const HandDef& def, double time) {
  assert(!def.path.empty());
  std::size_t next = 0;
  while (next < def.path.size() && def.path[next].time <= time) ++next;
  if (next == 0) return def.path.front().offset;
  if (next == def.path.size()) return def.path.back().offset;
  const HandKey &a = def.path[next - 1], &b = def.path[next];
  return a.offset + (b.offset - a.offset) * ((time - a.time) / (b.time - a.time));
}

/// SplitMix64 (Steele, Lea, Flood 2014).
double noise_at(std::uint64_t seed, std::uint64_t particle, std::uint64_t axis) {
  assert(axis < 3);
  std::uint64_t z = seed * 0x9e3779b97f4a7c15 + particle * 3 + axis + 1;
  for (int round = 0; round < 2; ++round) {
    z += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    z ^= z >> 31;
  }
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

}  // namespace weft
