// Cuts held strips off the triangles of a mesh.

#include "core/cloth/held_strip.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace weft {
namespace {

using Place = std::array<double, 2>;
using Polygon = std::vector<Place>;

/// The piece of a convex polygon that lies beyond a strip.
Polygon cut(const Polygon& whole, const HeldStrip& strip) {
  Polygon rest;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    const Place &a = whole[k], &b = whole[(k + 1) % whole.size()];
    const double from = distance_beyond(strip, a), to = distance_beyond(strip, b);
    if (from > 0) rest.push_back(a);
    if ((from > 0) == (to > 0)) continue;
    const double s = from / (from - to);
    rest.push_back({a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])});
  }
  return rest;
}

double doubled_area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Place &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return std::abs(sum);
}

}  // namespace

double distance_beyond(const HeldStrip& strip, const Place& place) {
  const double x = place[static_cast<std::size_t>(strip.axis)];
  return strip.far_side ? strip.border - x : x - strip.border;
}

bool holds(const HeldStrip& strip, const Place& place) {
  return !(distance_beyond(strip, place) > 0);
}

double free_part(const std::vector<HeldStrip>& strips, const RestCorners& corners) {
  const auto is_held = [&](const Place& corner) {
    return std::any_of(strips.begin(), strips.end(),
                       [&](const HeldStrip& strip) { return holds(strip, corner); });
  };
  if (std::all_of(corners.begin(), corners.end(), is_held)) return 0;
  const Polygon whole(corners.begin(), corners.end());
  Polygon rest = whole;
  for (const HeldStrip& strip : strips) rest = cut(rest, strip);
  const double area = doubled_area(whole);
  assert(area > 0);
  // Rounding leaves something of a corner that is free by a hair.
  return std::max(doubled_area(rest) / area, std::numeric_limits<double>::min());
}

}  // namespace weft
