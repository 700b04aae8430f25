// Finds the particles that a disc holds, and the factors of the bending at its circle.

#include "core/attachments/clamp_disc.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/attachments/clamp_line.h"
#include "core/attachments/constants.h"

namespace weft {
namespace {

template <class Real>
std::array<double, 2> place_of(const ClothModel<Real>& model, Index particle) {
  const auto& place = model.material[static_cast<std::size_t>(particle)];
  return {static_cast<double>(place[0]), static_cast<double>(place[1])};
}

}  // namespace

double ClampDisc::beyond(const std::array<double, 2>& place, std::size_t axis) const {
  assert(axis < 2 && radius > 0);
  const double along = place[axis] - middle[axis], across = place[1 - axis] - middle[1 - axis];
  if (std::abs(across) >= radius - slack()) return std::numeric_limits<double>::infinity();
  return (std::abs(along) - std::sqrt(radius * radius - across * across)) / cell[axis];
}

bool ClampDisc::holds(const std::array<double, 2>& place) const {
  const double least = std::min(beyond(place, 0), beyond(place, 1));
  return least < kMostBeyond - slack() / std::min(cell[0], cell[1]);
}

template <class Real>
std::optional<ClampDisc> clamp_of_disc(const ClothModel<Real>& model, Index centre, double radius) {
  const ClothPart<Real>& part = part_of_particle(model, centre);
  // A grid without rigidity gets a clamp too: its fabric may change while it runs.
  if (part.cells.rows == 0 || part.hinges.count > 0) return std::nullopt;
  const ClampDisc disc{static_cast<std::size_t>(&part - model.parts.data()),
                       place_of(model, centre),
                       radius,
                       {cell_of(part, 0), cell_of(part, 1)}};
  if (radius + disc.slack() < kLeastClampedDisc * std::max(disc.cell[0], disc.cell[1]))
    return std::nullopt;
  return disc;
}

template <class Real>
std::vector<Index> particles_of_disc(const ClampDisc& disc, const ClothModel<Real>& model) {
  assert(disc.part < model.parts.size());
  const IndexRange& range = model.parts[disc.part].particles;
  std::vector<Index> held;
  for (Index i = range.first; i < range.end(); ++i)
    if (disc.holds(place_of(model, i))) held.push_back(i);
  return held;
}

template <class Real>
void put_disc(const ClampDisc& disc, std::span<const Index> held, const ClothModel<Real>& model,
              const std::vector<Index>& sites, std::vector<std::array<double, 2>>& factors) {
  const ClothPart<Real>& part = model.parts[disc.part];
  assert(factors.size() == part.cells.particles.size());
  for (const Index particle : held) {
    const std::array<double, 2> place = place_of(model, particle);
    assert(disc.holds(place));
    const Index site = sites[static_cast<std::size_t>(particle - part.particles.first)];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double along = place[axis] - disc.middle[axis];
      std::array<double, 2> next = place;
      next[axis] += std::copysign(disc.cell[axis], along);
      const double beyond = disc.beyond(place, axis);
      // A line that touches the circle, or has one held particle, does not bend there.
      if (along == 0 || beyond >= 1 - disc.slack() / disc.cell[axis] || disc.holds(next)) continue;
      assert(beyond > kMostBeyond - 1.001);
      factors[static_cast<std::size_t>(site)][axis] =
          std::round(kStiffeningParts / (0.5 + beyond)) / kStiffeningParts;
    }
  }
}

#define WEFT_INSTANTIATE(Real)                                                              \
  template std::optional<ClampDisc> clamp_of_disc(const ClothModel<Real>&, Index, double);  \
  template std::vector<Index> particles_of_disc(const ClampDisc&, const ClothModel<Real>&); \
  template void put_disc(const ClampDisc&, std::span<const Index>, const ClothModel<Real>&, \
                         const std::vector<Index>&, std::vector<std::array<double, 2>>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
