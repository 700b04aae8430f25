#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

// The quadratic bending form along one line of a grid level.

namespace weft {

/// Contribution of the quadratic bending form to one line of particles of a level and its
/// neighbours. Distances are in units of the level's regular one; where all are regular, `bend` is
/// that of second differences 1 -2 1 and `slope` that of first differences -1 1.
template <class Real>
struct BendingLine {
  std::array<Real, 5> bend{};   ///< of the line two before, before, itself, after, two after
  std::array<Real, 3> slope{};  ///< of the line before, itself, after
  Real width = 0;               ///< of the cells before and after together
};

/// All lines of a level in one direction.
/// @param at    their positions, in cells of the finest level, ascending; at least two
/// @param unit  the regular distance
/// @param stiffening  factors of the bending about each line; empty: 1
template <class Real>
std::vector<BendingLine<Real>> bending_lines(const std::vector<int>& at, int unit,
                                             const std::vector<double>& stiffening) {
  assert(at.size() >= 2 && unit >= 1);
  assert(stiffening.empty() || stiffening.size() == at.size());
  std::vector<BendingLine<Real>> lines(at.size());
  const auto step = [&](std::size_t k) {  // from line k to the next
    assert(at[k + 1] > at[k]);
    return static_cast<Real>(at[k + 1] - at[k]) / static_cast<Real>(unit);
  };
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const Real stiffness = 1 / step(k);
    for (const std::size_t end : {k, k + 1}) {
      lines[end].slope[1] += stiffness;
      lines[end].width += step(k);
    }
    lines[k].slope[2] -= stiffness;
    lines[k + 1].slope[0] -= stiffness;
  }
  for (std::size_t k = 1; k + 1 < at.size(); ++k) {
    // The curvature is 2 / (a + b) times the change of slope, over a length of (a + b) / 2.
    const Real before = step(k - 1), behind = step(k);
    const Real factor = stiffening.empty() ? Real(1) : static_cast<Real>(stiffening[k]);
    const Real share = 2 / (before + behind) * factor;
    const Real change[3] = {1 / before, -1 / before - 1 / behind, 1 / behind};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j)
        lines[k + i - 1].bend[2 + j - i] += share * change[i] * change[j];
    }
  }
  return lines;
}

}  // namespace weft
