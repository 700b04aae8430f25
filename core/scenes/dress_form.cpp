// Lofts the dress form from elliptical sections.

#include "core/scenes/dress_form.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace weft {
namespace {

using std::numbers::pi;

/// A horizontal section: an ellipse with different front and back halves.
struct Section {
  double height;  ///< y [m]
  double width;   ///< half, along x [m]
  double front;   ///< depth along +z [m]
  double back;    ///< depth along -z [m]
};

/// Sections of the body from the lower rim to the neck, for a common dress size.
constexpr std::array<Section, 12> kBody = {{{0.720, 0.150, 0.104, 0.112},
                                            {0.780, 0.172, 0.114, 0.132},
                                            {0.850, 0.180, 0.115, 0.138},
                                            {0.940, 0.165, 0.105, 0.118},
                                            {1.045, 0.121, 0.088, 0.086},
                                            {1.130, 0.135, 0.098, 0.088},
                                            {1.215, 0.154, 0.112, 0.098},
                                            {1.300, 0.168, 0.104, 0.104},
                                            {1.375, 0.176, 0.078, 0.092},
                                            {1.425, 0.122, 0.060, 0.070},
                                            {1.460, 0.064, 0.054, 0.058},
                                            {1.520, 0.056, 0.050, 0.053}}};

/// One of the two bumps of the bust.
constexpr double kBustHeight = 1.215, kBustAngle = 0.62, kBustDepth = 0.042, kBustSpread = 0.075;

/// Catmull-Rom interpolation of four values at 0 <= t <= 1 between the middle two.
double interpolate(double a, double b, double c, double d, double t) {
  assert(t >= 0 && t <= 1);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/// Section at `position` in the table, 0 to 11.
Section section_at(double position) {
  assert(position >= 0 && position <= 11);
  const auto k = static_cast<std::ptrdiff_t>(std::min(std::floor(position), 10.0));
  const double t = position - static_cast<double>(k);
  const auto at = [](std::ptrdiff_t n) {
    return kBody[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(n, 0, 11))];
  };
  const Section a = at(k - 1), b = at(k), c = at(k + 1), d = at(k + 2);
  return {interpolate(a.height, b.height, c.height, d.height, t),
          interpolate(a.width, b.width, c.width, d.width, t),
          interpolate(a.front, b.front, c.front, d.front, t),
          interpolate(a.back, b.back, c.back, d.back, t)};
}

/// Height of the bust above the ellipse at angle phi from the front [m].
double bust(double height, double phi) {
  const double up = (height - kBustHeight) / kBustSpread;
  double sum = 0;
  for (const double side : {-1.0, 1.0}) {
    const double around = (phi - side * kBustAngle) / 0.42;
    sum += std::exp(-up * up - around * around);
  }
  return kBustDepth * sum;
}

/// Builds a closed surface ring by ring, from the bottom up.
class Loft {
 public:
  explicit Loft(const Vec3d& bottom) { mesh_.positions.push_back(bottom); }

  /// @param point  point(phi) for angles phi from the front, turning towards +x
  template <class Point>
  void add_ring(int count, Point&& point) {
    assert(count >= 3);
    const auto start = static_cast<Index>(mesh_.positions.size());
    for (int n = 0; n < count; ++n) mesh_.positions.push_back(point(2 * pi * n / count));
    if (count_ == 0)
      fan(start, count, 0, false);
    else
      stitch(start, count);
    start_ = start;
    count_ = count;
  }

  TriangleMesh close(const Vec3d& top) {
    assert(count_ > 0 && "a ring comes first");
    mesh_.positions.push_back(top);
    fan(start_, count_, static_cast<Index>(mesh_.positions.size()) - 1, true);
    return std::move(mesh_);
  }

 private:
  void fan(Index start, int count, Index pole, bool above) {
    for (int n = 0; n < count; ++n) {
      const Index a = start + n, b = start + (n + 1) % count;
      mesh_.triangles.push_back(above ? Triangle{a, b, pole} : Triangle{b, a, pole});
    }
  }

  /// Joins the last ring to a new one, always advancing on the ring that lags in angle.
  void stitch(Index start, int count) {
    int below = 0, above = 0;
    while (below < count_ || above < count) {
      const Index b = start_ + below % count_, a = start + above % count;
      const bool advance_below =
          above == count || (below < count_ && (below + 0.5) * count < (above + 0.5) * count_);
      if (advance_below) {
        mesh_.triangles.push_back({b, start_ + (below + 1) % count_, a});
        ++below;
      } else {
        mesh_.triangles.push_back({b, start + (above + 1) % count, a});
        ++above;
      }
    }
  }

  TriangleMesh mesh_;
  Index start_ = 0;
  int count_ = 0;
};

}  // namespace

TriangleMesh make_dress_form() {
  const auto circle = [](double radius, double height) {
    return
        [=](double phi) { return Vec3d(radius * std::sin(phi), height, radius * std::cos(phi)); };
  };
  // The rings have 709 vertices in total, and a closed loft has twice as many triangles.
  Loft loft(Vec3d(0, 0, 0));
  loft.add_ring(16, circle(0.170, 0.000));
  loft.add_ring(16, circle(0.165, 0.018));
  loft.add_ring(15, circle(0.060, 0.040));
  for (int n = 0; n < 7; ++n) loft.add_ring(8, circle(0.019, 0.065 + 0.634 * n / 6));
  loft.add_ring(18, circle(0.085, 0.708));
  constexpr int kBodyRings = 21;
  for (int n = 0; n < kBodyRings; ++n) {
    const Section s = section_at(11.0 * n / (kBodyRings - 1));
    loft.add_ring(28, [&](double phi) {
      const double depth = std::cos(phi) > 0 ? s.front : s.back;
      const double hill = bust(s.height, phi > pi ? phi - 2 * pi : phi);
      return Vec3d((s.width + 0.3 * hill) * std::sin(phi), s.height, depth * std::cos(phi) + hill);
    });
  }
  TriangleMesh form = loft.close(Vec3d(0, 1.530, 0));
  // Rounded to micrometres: the last bits of the library's sine differ between processors.
  for (Vec3d& p : form.positions) p = (p * 1e6).array().round() / 1e6;
  return form;
}

}  // namespace weft
