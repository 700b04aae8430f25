// Finds the lines that strips hold, and stiffens the bending at their borders.

#include "core/attachments/clamp_line.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/attachments/constants.h"
#include "core/cloth/mesh_bending.h"
#include "core/cloth/stability_bound.h"

namespace weft {
namespace {

/// Factors of one part while they are put together.
struct BendingFactors {
  std::vector<double> rows, columns;
  std::vector<std::array<double, 2>> sites;
};

/// @param lines  that the part has in this direction
void put(const ClampLine& clamp, int lines, std::vector<double>& factors) {
  assert(clamp.line >= 0 && clamp.line < lines);
  if (factors.empty()) factors.assign(static_cast<std::size_t>(lines), 1);
  factors[static_cast<std::size_t>(clamp.line)] = clamp.stiffening;
}

/// The sites of a grid's particles.
template <class Real>
std::vector<Index> sites_of(const ClothPart<Real>& part) {
  const std::vector<Index>& particles = part.cells.particles;
  std::vector<Index> sites(static_cast<std::size_t>(part.particles.count), 0);
  for (std::size_t site = 0; site < particles.size(); ++site) {
    if (particles[site] != kNone)
      sites[static_cast<std::size_t>(particles[site])] = static_cast<Index>(site);
  }
  return sites;
}

/// The factor of the row that both ends of a hinge's edge lie on, or else of the column.
/// @param a,b  numbers of the ends' places in the grid
double stiffening_between(int a, int b, const GridCells& cells) {
  if (a / cells.columns == b / cells.columns) return cells.stiffening_of_row(a / cells.columns);
  if (a % cells.columns == b % cells.columns) return cells.stiffening_of_column(a % cells.columns);
  return 1;
}

}  // namespace

HeldLines held_lines(double width, double slack, int all) {
  assert(width >= 0 && slack >= 0 && all >= 2);
  if (width <= slack) return {1, 1};
  const double cells = std::floor(width + slack);
  if (cells >= all - 1) return {all, 1};
  int last = static_cast<int>(cells);
  double beyond = width - last;  // from the last held line to the clamp
  if (last == 0 || beyond > 0.5 - 1 / kMostStiffening) {
    ++last;
    --beyond;
  }
  if (last >= all - 1) return {all, 1};
  return {last + 1, std::round(kStiffeningParts / (0.5 - beyond)) / kStiffeningParts};
}

HeldStrip held_strip(const ClampLine& clamp) {
  return {axis_across(clamp.side), is_far(clamp.side), clamp.border};
}

bool ClampLine::is_within(const ClampLine& other) const {
  if (part != other.part || side != other.side) return false;
  return is_far(side) ? line > other.line : line < other.line;
}

namespace {

/// Gives a mesh its strips. @returns whether they are others than before
template <class Real>
bool set_strips(const std::vector<ClampLine>& clamps, std::size_t number, ClothPart<Real>& part) {
  std::vector<HeldStrip> strips;
  for (const ClampLine& clamp : clamps) {
    if (clamp.part != number || !part.bends_by_links) continue;
    strips.push_back(held_strip(clamp));
  }
  if (strips == part.held_strips) return false;
  part.held_strips = std::move(strips);
  return true;
}

}  // namespace

template <class Real>
double cell_of(const ClothPart<Real>& part, std::size_t axis) {
  assert(axis < 2);
  if (part.grid_springs)
    return static_cast<double>(axis == 0 ? part.grid_springs->rest_warp
                                         : part.grid_springs->rest_weft);
  return static_cast<double>(axis == 0 ? part.cell_u : part.cell_v);
}

template <class Real>
std::vector<std::size_t> set_clamps(const Clamps& clamps, ClothModel<Real>& model) {
  std::vector<BendingFactors> factors(model.parts.size());
  for (const ClampLine& line : clamps.lines) {
    assert(line.part < model.parts.size());
    if (model.parts[line.part].cells.rows == 0) continue;
    const auto reaches_beyond = [&](const ClampLine& other) { return line.is_within(other); };
    if (std::any_of(clamps.lines.begin(), clamps.lines.end(), reaches_beyond)) continue;
    const GridCells& cells = model.parts[line.part].cells;
    BendingFactors& of = factors[line.part];
    line.is_row() ? put(line, cells.rows, of.rows) : put(line, cells.columns, of.columns);
  }
  std::vector<std::vector<Index>> sites(model.parts.size());
  for (const HeldDisc& held : clamps.discs) {
    const std::size_t part = held.disc.part;
    assert(part < model.parts.size());
    if (sites[part].empty()) {
      sites[part] = sites_of(model.parts[part]);
      factors[part].sites.resize(model.parts[part].cells.particles.size(), {1, 1});
    }
    put_disc(held.disc, held.particles, model, sites[part], factors[part].sites);
  }
  std::vector<std::size_t> changed;
  for (std::size_t p = 0; p < factors.size(); ++p) {
    GridCells& cells = model.parts[p].cells;
    BendingFactors& of = factors[p];
    if (set_strips(clamps.lines, p, model.parts[p])) changed.push_back(p);
    if (cells.row_stiffening == of.rows && cells.column_stiffening == of.columns &&
        cells.site_stiffening == of.sites)
      continue;
    cells.row_stiffening = std::move(of.rows);
    cells.column_stiffening = std::move(of.columns);
    cells.site_stiffening = std::move(of.sites);
    changed.push_back(p);
  }
  return changed;
}

template <class Real>
void stiffen_hinges(std::size_t number, ClothModel<Real>& model) {
  assert(number < model.parts.size());
  const ClothPart<Real>& part = model.parts[number];
  const GridCells& cells = part.cells;
  if (cells.row_stiffening.empty() && cells.column_stiffening.empty()) return;
  const std::vector<Index> sites = sites_of(part);
  for (Index n = part.hinges.first; n < part.hinges.end(); ++n) {
    Hinge<Real>& hinge = model.hinges[static_cast<std::size_t>(n)];
    const auto site = [&](int end) {
      return sites[static_cast<std::size_t>(hinge.x[end] - part.particles.first)];
    };
    const auto factor = static_cast<Real>(stiffening_between(site(0), site(1), cells));
    hinge.stiffness *= factor;
    hinge.damping *= factor;
  }
}

template <class Real>
void renew_links(std::size_t number, ClothModel<Real>& model) {
  assert(number < model.parts.size());
  ClothPart<Real>& part = model.parts[number];
  if (part.bends_by_links) bend_by_links(model, part);
}

template <class Real>
void renew_bending_bounds(std::size_t number, ClothModel<Real>& model) {
  assert(number < model.parts.size());
  ClothPart<Real>& part = model.parts[number];
  part.hinges.count == 0 ? bound_quadratic_bending(model, part) : bound_hinges(model, part);
}

#define WEFT_INSTANTIATE(Real)                                                    \
  template double cell_of(const ClothPart<Real>&, std::size_t);                   \
  template std::vector<std::size_t> set_clamps(const Clamps&, ClothModel<Real>&); \
  template void stiffen_hinges(std::size_t, ClothModel<Real>&);                   \
  template void renew_links(std::size_t, ClothModel<Real>&);                      \
  template void renew_bending_bounds(std::size_t, ClothModel<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
