#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/attachments/clamp_disc.h"
#include "core/cloth/cloth_model.h"

// Where the border of a pinned strip clamps the cloth.

namespace weft {

enum class Side : std::uint8_t { top, bottom, left, right };

/// Axis of the fabric across a strip along a side: 0 u, 1 v.
constexpr int axis_across(Side side) {
  return side == Side::left || side == Side::right ? 0 : 1;
}

/// Whether a side is where its axis has its largest coordinate.
constexpr bool is_far(Side side) {
  return side == Side::right || side == Side::bottom;
}

/// Which lines of a grid a strip along one side holds.
struct HeldLines {
  int lines = 1;          ///< from the side on
  double stiffening = 1;  ///< of the bending about the last of them
};

/// The lines that a strip of some width holds, and how the cloth bends at its border.
///
/// The hinge at the last held line stands for half a cell on either side of it. But the cloth is
/// straight up to the clamp, e cells beyond that line, and bends from there to the middle of the
/// first free cell only: over 1/2 - e of a cell in place of a whole one. So it is 1 / (1/2 - e)
/// times as stiff, and the elastica is of second order in the cell for any e. Where this would pass
/// kMostStiffening the strip holds one line more, which then lies beyond the clamp (e < 0). A strip
/// of any width clamps, so it holds two lines at least; one of width 0 holds the outermost line,
/// about which the cloth turns freely.
/// @param width  of the strip, in cells, at least 0
/// @param slack  by which rounding may miss a line, in cells
/// @param all    lines that there are, at least 2; what holds all of them clamps nothing
HeldLines held_lines(double width, double slack, int all);

/// The border of a pinned strip, along rows or columns of a grid or across a mesh.
struct ClampLine {
  std::size_t part = 0;  ///< of the model
  Side side = Side::top;
  int line = 0;           ///< the last held row or column of a grid
  double stiffening = 1;  ///< see HeldLines
  double border = 0;      ///< coordinate across a mesh [m]; what it leaves free: mesh_bending.h

  bool is_row() const { return axis_across(side) == 1; }
  /// Whether a strip along the same side holds this line and more.
  bool is_within(const ClampLine& other) const;
};

/// The strip that a clamp across a mesh holds.
HeldStrip held_strip(const ClampLine& clamp);

/// A disc with the particles that it holds.
struct HeldDisc {
  ClampDisc disc;
  std::span<const Index> particles;
};

/// What clamps the cloths of a model.
struct Clamps {
  std::vector<ClampLine> lines;
  std::vector<HeldDisc> discs;
};

/// Distance of the lines along an axis of a grid, 0 u, 1 v [m]; 0 if the part is not a grid.
template <class Real>
double cell_of(const ClothPart<Real>& part, std::size_t axis);

/// Gives the grids of a model the factors of these clamps, and its meshes their strips, and those
/// of no others.
/// @returns the parts where these changed; what follows from them is then to be recomputed:
///          `stiffen_hinges`, `renew_links`, `renew_bending_bounds`, and whatever else was prepared
///          from the model
template <class Real>
std::vector<std::size_t> set_clamps(const Clamps& clamps, ClothModel<Real>& model);

/// Multiplies a part's hinges along the clamped lines by the factors.
/// @param model  with the hinges of this part as built
template <class Real>
void stiffen_hinges(std::size_t part, ClothModel<Real>& model);

/// Recomputes the links of a mesh that bends by them.
template <class Real>
void renew_links(std::size_t part, ClothModel<Real>& model);

/// Recomputes the bounds of a part's bending; those of the membrane stay.
template <class Real>
void renew_bending_bounds(std::size_t part, ClothModel<Real>& model);

}  // namespace weft
