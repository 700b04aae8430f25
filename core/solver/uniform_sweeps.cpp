// Sweeps over a strained cloth at rest, and the stress that their multipliers are.

#include "core/solver/uniform_sweeps.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/cloth/edge_slope.h"
#include "core/forces/membrane.h"
#include "core/solver/constants.h"
#include "core/solver/grid_relaxation.h"
#include "core/solver/membrane_relaxation.h"
#include "core/solver/relaxation.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// The cloth with a uniform strain, in the plane z = 0.
Vec3Array<double> strained(const ClothModel<double>& model, const Vec3d& strain) {
  Vec3Array<double> x;
  for (const auto& [u, v] : model.material)
    x.emplace_back(u * (1 + strain[0]) + 0.5 * strain[2] * v,
                   v * (1 + strain[1]) + 0.5 * strain[2] * u, 0);
  return x;
}

/// Inverse masses, of which those on the border hold the strain.
std::vector<double> held_masses(const ClothModel<double>& model, const std::vector<char>& held) {
  std::vector<double> inverse;
  for (std::size_t i = 0; i < held.size(); ++i) inverse.push_back(held[i] ? 0 : 1 / model.mass[i]);
  return inverse;
}

/// Sweeps of a grid, and the multiplier of each spring after them.
std::vector<double> swept_rows(const ClothModel<double>& model, const Vec3Array<double>& x,
                               const std::vector<double>& inverse_mass, const SweptSubstep& substep,
                               GridRelaxation<double>& rows) {
  rows.set_masses(inverse_mass, substep.softness);
  rows.load(x, Vec3Array<double>(x.size(), Vec3d::Zero()), 1);
  const SweepView<double>& view = rows.view();
  for (int s = 0; s < substep.sweeps; ++s) {
    stop_point();
    sweep_grid(view, runs_forwards(s), s == 0, false);
  }
  std::vector<double> multipliers;
  for (std::size_t k = 0; k < model.springs.size(); ++k) {
    const Spring<double>& spring = model.springs[k];
    const bool rising = spring.j - spring.i == view.columns - 1;
    const Index cell = rising ? spring.i - 1 : spring.i;
    const std::ptrdiff_t r = cell / view.columns, c = cell % view.columns;
    const std::size_t table = model.spring_kinds[k] == SpringKind::warp   ? 0
                              : model.spring_kinds[k] == SpringKind::weft ? 1
                              : rising                                    ? 3
                                                                          : 2;
    multipliers.push_back(view.multiplier[table][r * view.stride + (c % 2) * view.half + c / 2]);
  }
  return multipliers;
}

/// The same spring by spring.
std::vector<double> swept_springs(const ClothModel<double>& model, const Vec3Array<double>& x,
                                  const std::vector<double>& w, const SweptSubstep& substep) {
  const std::size_t count = model.springs.size();
  std::vector<double> multipliers(count, 0);
  Vec3Array<double> moved = x;
  for (int s = 0; s < substep.sweeps; ++s) {
    stop_point();
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t k = runs_forwards(s) ? n : count - 1 - n;
      const Spring<double>& spring = model.springs[k];
      const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
      if (w[i] + w[j] == 0 || !(spring.stiffness > 0)) continue;
      const Vec3d delta = moved[j] - moved[i];
      const double length = delta.norm(), give = substep.softness / spring.stiffness;
      const double change =
          (length - spring.rest_length - give * multipliers[k]) / (w[i] + w[j] + give);
      multipliers[k] += change;
      moved[i] += delta * (change / length * w[i]);
      moved[j] -= delta * (change / length * w[j]);
    }
  }
  return multipliers;
}

/// Whether a site lies in the square in the middle of a grid, and on its border.
struct MiddleOfGrid {
  int top, left;  ///< of the square, in cells

  explicit MiddleOfGrid(const GridCells& g)
      : top((g.rows - 1 - kProbedCells) / 2), left((g.columns - 1 - kProbedCells) / 2) {
    assert(top > 0 && left > 0);
  }
  bool contains(int r, int c) const {
    return r >= top && r <= top + kProbedCells && c >= left && c <= left + kProbedCells;
  }
};

/// Mean stress in the middle of a grid, of forces along its springs.
Vec3d mean_stress(const ClothModel<double>& model, const std::vector<double>& forces) {
  const GridCells& g = model.parts.front().cells;
  const MiddleOfGrid middle(g);
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const Spring<double>& s = model.springs[k];
    const int r0 = s.i / g.columns, c0 = s.i % g.columns, r1 = s.j / g.columns,
              c1 = s.j % g.columns;
    if (!middle.contains(r0, c0) || !middle.contains(r1, c1)) continue;
    // A spring on the square's border belongs to it by half.
    const bool along_row = r0 == r1 && (r0 == middle.top || r0 == middle.top + kProbedCells);
    const bool down = c0 == c1 && (c0 == middle.left || c0 == middle.left + kProbedCells);
    const auto &a = model.material[static_cast<std::size_t>(s.i)],
               &b = model.material[static_cast<std::size_t>(s.j)];
    const double du = b[0] - a[0], dv = b[1] - a[1], length = std::hypot(du, dv);
    sum +=
        Vec3d(du * du, dv * dv, du * dv) * (forces[k] / length * (along_row || down ? 0.5 : 1.0));
  }
  const auto& part = model.parts.front();
  return sum / (part.cell_u * part.cell_v * kProbedCells * kProbedCells);
}

/// By unit strains.
template <class Stress>
SweptTensor tensor_of(const SweptSubstep& substep, const Stress& stress) {
  SweptTensor tensor = SweptTensor::Zero();
  for (int k = 0; k < 3; ++k) tensor.col(k) = stress(kProbedStrain * Vec3d::Unit(k));
  return tensor * (substep.softness / kProbedStrain);
}

/// Fewest edges from the border, by particle.
std::vector<int> rings_of(const ClothModel<double>& model) {
  const std::vector<EdgeSides> edges = sides_of(model.triangles);
  std::vector<int> ring(model.mass.size(), kMostRings);
  for (const EdgeSides& edge : edges) {
    if (!edge.is_border()) continue;
    for (const Index i : edge.ends) ring[static_cast<std::size_t>(i)] = 0;
  }
  for (int round = 0; round < kMostRings; ++round) {
    for (const EdgeSides& edge : edges) {
      int &a = ring[static_cast<std::size_t>(edge.ends[0])],
          &b = ring[static_cast<std::size_t>(edge.ends[1])];
      a = std::min(a, b + 1);
      b = std::min(b, a + 1);
    }
  }
  return ring;
}

/// Multipliers of a mesh's triangles after the sweeps.
Vec3Array<double> swept_triangles(const ClothModel<double>& model, const Vec3Array<double>& x,
                                  const std::vector<double>& w, const SweptSubstep& substep) {
  const std::size_t count = model.membrane.size();
  Vec3Array<double> multipliers(count, Vec3d::Zero()), place = x;
  for (int s = 0; s < substep.sweeps; ++s) {
    stop_point();
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t k = runs_forwards(s) ? n : count - 1 - n;
      const MembraneTriangle<double>& t = model.membrane[k];
      const auto at = [&](std::size_t c) { return static_cast<std::size_t>(t.x[c]); };
      const std::array<double, 3> own = {w[at(0)], w[at(1)], w[at(2)]};
      if (own[0] + own[1] + own[2] == 0) continue;
      const MembraneStrain<double> strain =
          membrane_strain<double>(t, place[at(1)] - place[at(0)], place[at(2)] - place[at(0)]);
      const std::array<Vec3d, 3> moved = relax_membrane(
          model.parts.front().membrane_tensor, t, substep.softness, own, strain, multipliers[k]);
      for (std::size_t c = 0; c < 3; ++c) place[at(c)] += moved[c];
    }
  }
  return multipliers;
}

}  // namespace

SweptTensor swept_tensor_of_grid(const ClothModel<double>& model, const SweptSubstep& substep) {
  assert(model.parts.size() == 1 && substep.softness > 0 && substep.sweeps >= 1);
  const ClothPart<double>& part = model.parts.front();
  std::vector<char> held;
  for (int r = 0; r < part.rows; ++r) {
    for (int c = 0; c < part.columns; ++c)
      held.push_back(r == 0 || c == 0 || r + 1 == part.rows || c + 1 == part.columns);
  }
  const std::vector<double> inverse_mass = held_masses(model, held);
  GridRelaxation<double> rows;
  rows.prepare(part);
  return tensor_of(substep, [&](const Vec3d& strain) {
    const Vec3Array<double> x = strained(model, strain);
    return mean_stress(model, rows.fits() ? swept_rows(model, x, inverse_mass, substep, rows)
                                          : swept_springs(model, x, inverse_mass, substep));
  });
}

SweptTensor swept_tensor_of_mesh(const ClothModel<double>& model, const SweptSubstep& substep) {
  assert(model.parts.size() == 1 && substep.softness > 0 && substep.sweeps >= 1);
  const std::vector<int> rings = rings_of(model);
  std::vector<char> held;
  for (const int ring : rings) held.push_back(ring == 0);
  const int deepest = rings.empty() ? 0 : *std::max_element(rings.begin(), rings.end());
  const int inside = std::min(kMostRings, deepest) - 1;
  if (inside < 1) return SweptTensor::Zero();
  const std::vector<double> inverse_mass = held_masses(model, held);
  return tensor_of(substep, [&](const Vec3d& strain) {
    const Vec3Array<double> multipliers =
        swept_triangles(model, strained(model, strain), inverse_mass, substep);
    Vec3d sum = Vec3d::Zero();
    double area = 0;
    for (std::size_t k = 0; k < multipliers.size(); ++k) {
      const MembraneTriangle<double>& t = model.membrane[k];
      const auto is_inside = [&](Index i) { return rings[static_cast<std::size_t>(i)] >= inside; };
      if (!std::all_of(std::begin(t.x), std::end(t.x), is_inside)) continue;
      sum += multipliers[k];
      area += t.area;
    }
    return area > 0 ? (sum / area).eval() : Vec3d::Zero().eval();
  });
}

}  // namespace weft
