// Shadow, hem and folds of a draped specimen.

#include "core/diagnostics/drape.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

namespace weft {
namespace {

using std::numbers::pi;

/// Sample points in a square around the middle, marked if a triangle lies above them.
class Shadow {
 public:
  explicit Shadow(double reach)
      : side_(static_cast<int>(std::ceil(2 * reach / kShadowSpacing)) + 2),
        marks_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), false) {}

  /// Adds a triangle; corners are relative to the middle, as (x, z).
  void add(const std::array<std::array<double, 2>, 3>& corners) {
    const auto [low_u, high_u] = range(corners, 0);
    const auto [low_v, high_v] = range(corners, 1);
    for (int i = low_u; i <= high_u; ++i) {
      for (int j = low_v; j <= high_v; ++j) {
        if (covers(corners, at(i), at(j))) marks_[index(i, j)] = true;
      }
    }
  }

  double area() const {
    return kShadowSpacing * kShadowSpacing *
           static_cast<double>(std::count(marks_.begin(), marks_.end(), true));
  }

 private:
  double at(int k) const { return (k - 0.5 * (side_ - 1)) * kShadowSpacing; }
  std::size_t index(int i, int j) const {
    assert(i >= 0 && i < side_ && j >= 0 && j < side_);
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(j);
  }
  std::pair<int, int> range(const std::array<std::array<double, 2>, 3>& p, std::size_t k) const {
    const double low = std::min({p[0][k], p[1][k], p[2][k]});
    const double high = std::max({p[0][k], p[1][k], p[2][k]});
    const double middle = 0.5 * (side_ - 1);
    return {std::max(0, static_cast<int>(std::ceil(low / kShadowSpacing + middle))),
            std::min(side_ - 1, static_cast<int>(std::floor(high / kShadowSpacing + middle)))};
  }
  static bool covers(const std::array<std::array<double, 2>, 3>& p, double u, double v) {
    int left = 0, right = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = p[k], &b = p[(k + 1) % 3];
      const double side = (b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0]);
      left += side >= 0;
      right += side <= 0;
    }
    return left == 3 || right == 3;
  }

  int side_;
  std::vector<bool> marks_;
};

/// Particles at edges with only one triangle.
template <class Real>
std::vector<Index> hem_particles(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  std::map<Edge, int> triangles;
  for (Index n = part.triangles.first; n < part.triangles.end(); ++n) {
    const Triangle& t = model.triangles[static_cast<std::size_t>(n)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      ++triangles[{std::min(a, b), std::max(a, b)}];
    }
  }
  std::vector<Index> hem;
  for (const auto& [edge, count] : triangles) {
    if (count == 1) hem.insert(hem.end(), edge.begin(), edge.end());
  }
  std::sort(hem.begin(), hem.end());
  hem.erase(std::unique(hem.begin(), hem.end()), hem.end());
  return hem;
}

/// Number of crests of a closed line of heights: a crest counts if the line falls by `least` on
/// both sides.
int count_crests(const std::vector<double>& heights, double least) {
  assert(!heights.empty() && least > 0);
  const std::size_t n = heights.size();
  const auto start =
      static_cast<std::size_t>(std::min_element(heights.begin(), heights.end()) - heights.begin());
  int crests = 0;
  bool rising = true;
  double extreme = heights[start];
  for (std::size_t k = 1; k <= n; ++k) {
    const double h = heights[(start + k) % n];
    if (rising) {
      if (h > extreme) extreme = h;
      // The last crest is followed by the lowest point, where the walk began.
      if (h >= extreme - least || extreme - heights[start] < least) continue;
      ++crests;
      rising = false;
      extreme = h;
    } else if (h < extreme) {
      extreme = h;
    } else if (h > extreme + least) {
      rising = true;
      extreme = h;
    }
  }
  return crests;
}

}  // namespace

template <class Real>
DrapeMeasurement measure_drape(const ClothModel<Real>& model, const ClothPart<Real>& part,
                               const Vec3Array<Real>& x, const Vec3d& centre) {
  const auto from_centre = [&](Index i) {
    return (x[static_cast<std::size_t>(i)].template cast<double>() - centre).eval();
  };
  assert(x.size() == model.mass.size());
  Shadow shadow(2 * kDrapeSpecimenRadius);
  double flat = 0;
  for (Index n = part.triangles.first; n < part.triangles.end(); ++n) {
    std::array<std::array<double, 2>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = from_centre(model.triangles[static_cast<std::size_t>(n)][k]);
      corners[k] = {p[0], p[2]};
    }
    shadow.add(corners);
    flat += static_cast<double>(model.triangle_area[static_cast<std::size_t>(n)]);
  }
  DrapeMeasurement result;
  const double disc = pi * kDrapeSupportRadius * kDrapeSupportRadius;
  result.coefficient = 100 * (shadow.area() - disc) / (flat - disc);

  // The hem, sampled in even directions. The overhang is rescaled to that of a round specimen, so
  // that the staircase of a cut grid does not count as folds.
  std::vector<double> sum(kHemDirections, 0), weight(kHemDirections, 0);
  const std::vector<Index> hem = hem_particles(model, part);
  const auto material = [&](Index i, std::size_t k) {
    return static_cast<double>(model.material[static_cast<std::size_t>(i)][k]);
  };
  double middle[2] = {0, 0};
  for (const Index i : hem) {
    for (std::size_t k = 0; k < 2; ++k)
      middle[k] += material(i, k) / static_cast<double>(hem.size());
  }
  for (const Index i : hem) {
    const Vec3d p = from_centre(i);
    result.droop -= p[1] / static_cast<double>(hem.size());
    const double own = std::hypot(material(i, 0) - middle[0], material(i, 1) - middle[1]);
    if (own < kLeastHemRadius * kDrapeSupportRadius) continue;
    const double radius_if_round =
        kDrapeSupportRadius + (std::hypot(p[0], p[2]) - kDrapeSupportRadius) *
                                  (kDrapeSpecimenRadius - kDrapeSupportRadius) /
                                  (own - kDrapeSupportRadius);
    const double place = (std::atan2(p[2], p[0]) / (2 * pi) + 1) * kHemDirections;
    constexpr int kReach = 6;
    for (int k = -kReach; k <= kReach; ++k) {
      const double direction = std::round(place) + k, off = (direction - place) / 3;
      const auto slot = static_cast<std::size_t>(static_cast<long>(direction) % kHemDirections);
      const double w = std::exp(-off * off);
      sum[slot] += w * radius_if_round;
      weight[slot] += w;
    }
  }
  std::vector<double> radius;
  for (std::size_t k = 0; k < kHemDirections; ++k) {
    if (weight[k] > 0) radius.push_back(sum[k] / weight[k]);
  }
  if (!radius.empty()) result.folds = count_crests(radius, kLeastCrest);
  return result;
}

template DrapeMeasurement measure_drape(const ClothModel<float>&, const ClothPart<float>&,
                                        const Vec3Array<float>&, const Vec3d&);
template DrapeMeasurement measure_drape(const ClothModel<double>&, const ClothPart<double>&,
                                        const Vec3Array<double>&, const Vec3d&);

}  // namespace weft
