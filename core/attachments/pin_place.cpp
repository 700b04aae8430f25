// Finds the particles of corners, strips, points and discs.

#include "core/attachments/pin_place.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/attachments/constants.h"
#include "core/cloth/held_strip.h"
#include "core/error.h"

namespace weft {
namespace {

struct MaterialBounds {
  std::array<double, 2> low, high;
};

template <class Real>
MaterialBounds bounds_of(const ClothModel<Real>& model, const IndexRange& range) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  MaterialBounds bounds{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (Index i = range.first; i < range.end(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto value = static_cast<double>(model.material[static_cast<std::size_t>(i)][k]);
      bounds.low[k] = std::min(bounds.low[k], value);
      bounds.high[k] = std::max(bounds.high[k], value);
    }
  }
  return bounds;
}

template <class Real>
const ClothPart<Real>& named_part(const ClothModel<Real>& model, const std::string& name) {
  std::string names;
  for (const ClothPart<Real>& part : model.parts) {
    if (part.name == name) return part;
    names += (names.empty() ? "" : ", ") + part.name;
  }
  throw DefinitionError("pin.cloth", name, "one of " + names);
}

template <class Real>
Index nearest_particle(const ClothModel<Real>& model, const IndexRange& range,
                       const MaterialPoint& point) {
  visit_fields_of_point(
      point, [](const FieldInfo& info, double value) { check_field("pin.", info, value); });
  assert(range.count > 0);
  const MaterialBounds bounds = bounds_of(model, range);
  const std::array<double, 2> fraction = {point.u, point.v};
  Index nearest = range.first;
  double least = std::numeric_limits<double>::infinity();
  for (Index i = range.first; i < range.end(); ++i) {
    double distance2 = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double wanted = bounds.low[k] + fraction[k] * (bounds.high[k] - bounds.low[k]);
      const double d = static_cast<double>(model.material[static_cast<std::size_t>(i)][k]) - wanted;
      distance2 += d * d;
    }
    if (distance2 >= least) continue;
    least = distance2;
    nearest = i;
  }
  return nearest;
}

/// The width that a strip holds of a grid, and its clamp.
/// @param low, high  material coordinates of the outermost lines across the strip [m]
double held_width(const EdgeStrip& strip, double cell, double low, double high, double slack,
                  std::size_t part, std::optional<ClampLine>& clamp) {
  assert(cell > 0 && high > low);
  const int all = static_cast<int>(std::lround((high - low) / cell)) + 1;
  const HeldLines held = held_lines(strip.width / cell, slack / cell, all);
  const int last = held.lines - 1;
  if (last > 0 && held.lines < all) {
    const bool far_side = is_far(strip.side);
    const int first = static_cast<int>(std::lround((far_side ? high : low) / cell));
    clamp = {part, strip.side, far_side ? first - last : first + last, held.stiffening};
  }
  return last * cell;
}

/// The border of a strip of a mesh, if it holds triangles and leaves others free.
/// @param border  of the strip [m]
template <class Real>
std::optional<ClampLine> clamp_of_mesh(const ClothModel<Real>& model, const ClothPart<Real>& part,
                                       Side side, double border) {
  const auto number = static_cast<std::size_t>(&part - model.parts.data());
  const ClampLine clamp{number, side, 0, 1, border};
  if (part.hinges.count > 0) return std::nullopt;  // without rigidity it may get some later
  const HeldStrip strip = held_strip(clamp);
  Index held = 0;
  for (Index n = part.triangles.first; n < part.triangles.end(); ++n) {
    const Triangle& t = model.triangles[static_cast<std::size_t>(n)];
    held += std::all_of(t.begin(), t.end(), [&](Index i) {
      const auto& place = model.material[static_cast<std::size_t>(i)];
      return holds(strip, {static_cast<double>(place[0]), static_cast<double>(place[1])});
    });
  }
  if (held == 0 || held == part.triangles.count) return std::nullopt;
  return clamp;
}

template <class Real>
PinnedParticles particles_of_strip(const ClothModel<Real>& model, const ClothPart<Real>& part,
                                   const EdgeStrip& strip) {
  const IndexRange& range = part.particles;
  visit_fields_of_strip(
      strip, [](const FieldInfo& info, auto value) { check_field("pin.", info, value); });
  const MaterialBounds bounds = bounds_of(model, range);
  const auto axis = static_cast<std::size_t>(axis_across(strip.side));
  const bool far_side = is_far(strip.side);
  const double slack = kStripSlack * (bounds.high[axis] - bounds.low[axis]);
  PinnedParticles held;
  double width = strip.width;
  if (const double cell = cell_of(part, axis); cell > 0)
    width = held_width(strip, cell, bounds.low[axis], bounds.high[axis], slack,
                       static_cast<std::size_t>(&part - model.parts.data()), held.clamp);
  else if (width > slack)
    held.clamp = clamp_of_mesh(
        model, part, strip.side,
        far_side ? bounds.high[axis] - width - slack : bounds.low[axis] + width + slack);
  for (Index i = range.first; i < range.end(); ++i) {
    const auto value = static_cast<double>(model.material[static_cast<std::size_t>(i)][axis]);
    const double inside = far_side ? bounds.high[axis] - value : value - bounds.low[axis];
    if (inside <= width + slack) held.particles.push_back(i);
  }
  assert(!held.particles.empty());
  const double across = far_side ? 1 : 0;
  held.centre = nearest_particle(
      model, range, axis == 0 ? MaterialPoint{across, 0.5} : MaterialPoint{0.5, across});
  // On a mesh the particle nearest to the middle of the side may lie outside the strip.
  if (!std::binary_search(held.particles.begin(), held.particles.end(), held.centre))
    held.centre = held.particles[held.particles.size() / 2];
  return held;
}

}  // namespace

template <class Real>
PinnedParticles find_pinned(const ClothModel<Real>& model, const PinDef& def) {
  visit_fields_of_pin(
      def, [](const FieldInfo& info, double value) { check_field("pin.", info, value); });
  const ClothPart<Real>& named =
      def.cloth.empty() ? model.parts.front() : named_part(model, def.cloth);
  const IndexRange part = named.particles;
  if (const auto* strip = std::get_if<EdgeStrip>(&def.place))
    return particles_of_strip(model, named, *strip);
  PinnedParticles held;
  if (const auto* index = std::get_if<Index>(&def.place)) {
    const IndexRange range = def.cloth.empty() ? IndexRange{0, model.particle_count()} : part;
    check_field("pin.", {"particle", 0, range.count - 1.0, "", "index of a particle"}, *index);
    held.centre = range.first + *index;
  } else if (const auto* corner = std::get_if<Corner>(&def.place)) {
    const bool right = *corner == Corner::top_right || *corner == Corner::bottom_right;
    const bool bottom = *corner == Corner::bottom_left || *corner == Corner::bottom_right;
    held.centre = nearest_particle(model, part, {right ? 1.0 : 0.0, bottom ? 1.0 : 0.0});
  } else {
    held.centre = nearest_particle(model, part, std::get<MaterialPoint>(def.place));
  }
  held.disc = clamp_of_disc(model, held.centre, def.radius);
  held.particles = held.disc ? particles_of_disc(*held.disc, model)
                             : particles_in_disc(model, held.centre, def.radius);
  assert(std::binary_search(held.particles.begin(), held.particles.end(), held.centre));
  return held;
}

template PinnedParticles find_pinned(const ClothModel<float>&, const PinDef&);
template PinnedParticles find_pinned(const ClothModel<double>&, const PinDef&);

}  // namespace weft
