// Compares what pins hold with what was asked for.

#include "core/world/pin_extent.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "core/cloth/corner_places.h"

namespace weft {
namespace {

using Place = Eigen::Vector2d;

/// Signed area of a disc about the origin that the triangle from its centre to a and b cuts out.
double area_to_side(const Place& a, const Place& b, double radius) {
  const auto sector = [&](const Place& p, const Place& q) {
    const double turn = std::atan2(p[0] * q[1] - p[1] * q[0], p.dot(q));
    return 0.5 * radius * radius * turn;
  };
  const Place along = b - a;
  const double length2 = along.squaredNorm();
  if (length2 == 0) return 0;
  const double middle = -a.dot(along) / length2;
  const double gap2 = radius * radius - (a + middle * along).squaredNorm();
  if (gap2 <= 0) return sector(a, b);
  const double half = std::sqrt(gap2 / length2);
  const double in = std::clamp(middle - half, 0.0, 1.0), out = std::clamp(middle + half, 0.0, 1.0);
  const Place enters = a + in * along, leaves = a + out * along;
  const double inside = 0.5 * (enters[0] * leaves[1] - enters[1] * leaves[0]);
  return (in > 0 ? sector(a, enters) : 0) + inside + (out < 1 ? sector(leaves, b) : 0);
}

template <class Real>
Place place_of(const ClothModel<Real>& model, Index i) {
  const auto& m = model.material[static_cast<std::size_t>(i)];
  return {static_cast<double>(m[0]), static_cast<double>(m[1])};
}

/// Area of a part within a disc in the fabric [m^2].
template <class Real>
double area_of_disc(const ClothModel<Real>& model, const ClothPart<Real>& part, const Place& centre,
                    double radius) {
  double area = 0;
  for (Index t = part.triangles.first; t < part.triangles.end(); ++t) {
    const CornerUv corners = corner_places(model, t);
    const auto at = [&](std::size_t k) -> Place {
      return Place(corners[k % 3][0], corners[k % 3][1]) - centre;
    };
    double within = 0;
    for (std::size_t k = 0; k < 3; ++k) within += area_to_side(at(k), at(k + 1), radius);
    area += std::abs(within);
  }
  return area;
}

bool differs(double asked, double held) {
  return std::abs(held - asked) > kToldDifference * asked;
}

template <class Real>
PinExtent disc(const ClothModel<Real>& model, const Pin& pin) {
  const ClothPart<Real>& part = part_of_particle(model, pin.centre);
  const Place centre = place_of(model, pin.centre);
  PinExtent extent;
  extent.asked = pin.def.radius;
  extent.asked_area = area_of_disc(model, part, centre, pin.def.radius);
  for (const Index i : pin.particles) {
    extent.held = std::max(extent.held, (place_of(model, i) - centre).norm());
    extent.held_area +=
        static_cast<double>(model.mass[static_cast<std::size_t>(i)]) / part.fabric.areal_density;
  }
  extent.clamps = pin.disc.has_value();
  return extent;
}

template <class Real>
PinExtent strip(const ClothModel<Real>& model, const Pin& pin, const EdgeStrip& def) {
  const IndexRange& range = part_of_particle(model, pin.centre).particles;
  const int axis = axis_across(def.side);
  const double sign = is_far(def.side) ? -1 : 1;
  const auto inwards = [&](Index i) { return sign * place_of(model, i)[axis]; };
  double border = inwards(range.first);
  for (Index i = range.first; i < range.end(); ++i) border = std::min(border, inwards(i));
  PinExtent extent;
  extent.asked = def.width;
  for (const Index i : pin.particles) extent.held = std::max(extent.held, inwards(i) - border);
  extent.clamps = pin.clamp.has_value();
  return extent;
}

std::string describe(const PinExtent& pin) {
  const std::string name = "pins[" + std::to_string(pin.pin) + "]: ";
  if (pin.all)
    return name + (pin.asked_area == 0 ? "a strip of " : "a disc of ") + rounded_text(pin.asked) +
           " m holds all of its cloth";
  const std::string clamped = pin.clamps ? ", and clamps it where it was asked to" : "";
  if (pin.asked_area == 0)
    return name + "a strip of " + rounded_text(pin.asked) + " m holds the fabric up to " +
           rounded_text(pin.held) + " m from its side" + clamped;
  const std::string reach = pin.held > 0
                                ? ", up to " + rounded_text(pin.held) + " m from its middle"
                                : ": a single particle";
  return name + "a disc of " + rounded_text(pin.asked) + " m holds " + rounded_text(pin.held_area) +
         " m2 of " + rounded_text(pin.asked_area) + reach + clamped;
}

}  // namespace

template <class Real>
std::vector<PinExtent> coarse_pins(const World<Real>& world) {
  std::vector<PinExtent> found;
  const std::vector<Pin>& pins = world.pins().list;
  for (std::size_t k = 0; k < std::min(pins.size(), world.def().pins.size()); ++k) {
    const auto* edge = std::get_if<EdgeStrip>(&pins[k].def.place);
    if (edge ? edge->width == 0 : pins[k].def.radius == 0) continue;
    PinExtent extent = edge ? strip(world.model(), pins[k], *edge) : disc(world.model(), pins[k]);
    extent.pin = k;
    extent.all = static_cast<Index>(pins[k].particles.size()) ==
                 part_of_particle(world.model(), pins[k].centre).particles.count;
    if (differs(extent.asked, extent.held) || differs(extent.asked_area, extent.held_area))
      found.push_back(extent);
  }
  return found;
}

std::string describe(const std::vector<PinExtent>& pins) {
  assert(!pins.empty());
  std::string text;
  const std::size_t named = std::min(pins.size(), kNamedPins);
  for (std::size_t k = 0; k < named; ++k) text += (k > 0 ? "; " : "") + describe(pins[k]);
  if (pins.size() > named) text += "; and " + std::to_string(pins.size() - named) + " more";
  if (std::all_of(pins.begin(), pins.end(), [](const PinExtent& pin) { return pin.all; }))
    return text;
  return text + ": whole particles are held, and a finer grid comes nearer";
}

template std::vector<PinExtent> coarse_pins(const World<float>&);
template std::vector<PinExtent> coarse_pins(const World<double>&);

}  // namespace weft
