// Orders particles by nested dissection.

#include "core/solver/implicit/dissection.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "core/solver/implicit/constants.h"

namespace weft {
namespace {

/// The axis along which the particles extend farthest.
Eigen::Index longest_axis(std::span<const Index> particles, const Vec3Array<double>& places) {
  Vec3d low = places[static_cast<std::size_t>(particles.front())], high = low;
  for (const Index i : particles) {
    low = low.cwiseMin(places[static_cast<std::size_t>(i)]);
    high = high.cwiseMax(places[static_cast<std::size_t>(i)]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

struct Dissection {
  const CouplingLists& coupled;
  const Vec3Array<double>& places;
  std::vector<int> side;  ///< of each particle: the last half that it was in
  int sides = 0;

  /// Orders the particles in place.
  void order(std::span<Index> particles) {
    if (particles.size() <= kUndividedParticles) return;
    const Eigen::Index axis = longest_axis(particles, places);
    const auto before = [&](Index a, Index b) {
      const double at_a = places[static_cast<std::size_t>(a)][axis],
                   at_b = places[static_cast<std::size_t>(b)][axis];
      return at_a != at_b ? at_a < at_b : a < b;
    };
    std::sort(particles.begin(), particles.end(), before);
    const std::size_t half = particles.size() / 2;
    const int behind = ++sides;
    for (const Index i : particles.subspan(half)) side[static_cast<std::size_t>(i)] = behind;
    const auto parts = [&](Index i) {
      const std::vector<Index>& others = coupled[static_cast<std::size_t>(i)];
      return std::any_of(others.begin(), others.end(), [&](Index other) {
        return side[static_cast<std::size_t>(other)] == behind;
      });
    };
    // In front, those that touch what is behind go last.
    const auto first = particles.begin();
    const auto middle = first + static_cast<std::ptrdiff_t>(half);
    const auto border = std::stable_partition(first, middle, [&](Index i) { return !parts(i); });
    const auto border_size = middle - border;
    std::rotate(border, middle, particles.end());
    const auto back_size = static_cast<std::size_t>(particles.end() - border - border_size);
    const auto front_size = static_cast<std::size_t>(border - first);
    order(particles.subspan(0, front_size));
    order(particles.subspan(front_size, back_size));
  }
};

}  // namespace

std::vector<Index> dissect(const CouplingLists& coupled, const Vec3Array<double>& places) {
  assert(coupled.size() == places.size());
  std::vector<Index> order(coupled.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  Dissection dissection{coupled, places, std::vector<int>(coupled.size(), 0)};
  dissection.order(order);
  return order;
}

}  // namespace weft
