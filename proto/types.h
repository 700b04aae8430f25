#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>

namespace weft::proto {

using Vec3 = std::array<double, 3>;
/// A rotation as unit quaternion x y z w.
using Quat = std::array<double, 4>;
using Quatf = std::array<float, 4>;
using Vec3f = std::array<float, 3>;

/// A command's id, chosen by its sender: an integer from 0 to 2^53 or 1 to 64 bytes of UTF-8.
using Id = std::variant<std::int64_t, std::string>;

/// Identifies a viewer while the server lives; 0 is the scene itself.
using ViewerId = std::uint32_t;

/// A collider: its name, 1 to 64 bytes, the first of that name; or its place in the list of `mesh`.
using ColliderRef = std::variant<std::string, std::uint32_t>;

}  // namespace weft::proto
