// Reads the textile tests off the first cloth.

#include "core/diagnostics/measurements.h"

#include <algorithm>
#include <cassert>

#include "core/cloth/fabric_presets.h"
#include "core/diagnostics/cantilever.h"
#include "core/diagnostics/drape.h"

namespace weft {
namespace {

template <class Real>
bool is_pinned(const ClothState<Real>& state, Index i) {
  return state.inverse_mass[static_cast<std::size_t>(i)] == 0;
}

template <class Real>
double largest_speed(const ClothPart<Real>& part, const Vec3Array<Real>& v) {
  double largest = 0;
  for (Index i = part.particles.first; i < part.particles.end(); ++i)
    largest = std::max(largest, static_cast<double>(v[static_cast<std::size_t>(i)].norm()));
  return largest;
}

template <class Real>
std::vector<NamedNumber> drape(const ClothModel<Real>& model, const ClothState<Real>& state,
                               const Vec3Array<Real>& v) {
  const ClothPart<Real>& part = model.parts.front();
  Vec3d centre = Vec3d::Zero();
  int pinned = 0;
  for (Index i = part.particles.first; i < part.particles.end(); ++i) {
    if (!is_pinned(state, i)) continue;
    centre += state.x[static_cast<std::size_t>(i)].template cast<double>();
    ++pinned;
  }
  if (pinned == 0) return {};
  const DrapeMeasurement m = measure_drape(model, part, state.x, (centre / pinned).eval());
  std::vector<NamedNumber> all = {{"drape_coefficient_percent", m.coefficient},
                                  {"folds", static_cast<double>(m.folds)},
                                  {"droop_m", m.droop},
                                  {"largest_speed_m_s", largest_speed(part, v)}};
  const DrapeBand published = published_drape(part.fabric);
  if (published.high > 0) {
    all.push_back({"published_low_percent", published.low});
    all.push_back({"published_high_percent", published.high});
  }
  return all;
}

/// A strip that is clamped at its first columns and hangs or swings by the others.
struct Strip {
  Vec3d clamp, tip;   ///< ends of what is free
  double length = 0;  ///< of what is free [m]
};

template <class Real>
std::optional<Strip> strip_of(const ClothModel<Real>& model, const ClothState<Real>& state) {
  const ClothPart<Real>& part = model.parts.front();
  const auto at = [&](int row, int column) {
    return part.particles.first + row * part.columns + column;
  };
  int pinned = 0;
  while (pinned < part.columns && is_pinned(state, at(0, pinned))) ++pinned;
  if (pinned == 0 || pinned == part.columns) return std::nullopt;
  const auto column = [&](int c) {
    Vec3d sum = Vec3d::Zero();
    for (int r = 0; r < part.rows; ++r)
      sum += state.x[static_cast<std::size_t>(at(r, c))].template cast<double>();
    return (sum / part.rows).eval();
  };
  // The hinge at the last pinned column stands for the fabric from the clamp to the middle of the
  // next cell; by itself (factor 1) it clamps half a cell behind.
  const Vec3d last = column(pinned - 1);
  const double beyond = pinned > 1 ? 0.5 - 1 / part.cells.stiffening_of_column(pinned - 1) : 0;
  const Vec3d along = last - column(std::max(pinned - 2, 0));
  return Strip{last + beyond * along, column(part.columns - 1),
               (part.columns - pinned - beyond) * static_cast<double>(part.cell_u)};
}

template <class Real>
std::vector<NamedNumber> decay(const ClothModel<Real>& model, const ClothState<Real>& state,
                               const Swing& swing) {
  if (!strip_of(model, state)) return {};
  std::vector<NamedNumber> all = {{"amplitude_m", swing.amplitude()}};
  const Swing::Decay found = swing.decay();
  if (found.period > 0) all.push_back({"swing_period_s", found.period});
  if (found.decay_time == 0) return all;
  all.push_back({"decay_time_s", found.decay_time});
  all.push_back({"loss_factor", found.loss_factor()});
  all.push_back({"relaxation_time_s", found.relaxation_time()});
  return all;
}

template <class Real>
std::vector<NamedNumber> cantilever(const ClothModel<Real>& model, const ClothState<Real>& state,
                                    const Vec3Array<Real>& v, double gravity) {
  const ClothPart<Real>& part = model.parts.front();
  const std::optional<Strip> strip = strip_of(model, state);
  if (!strip) return {};
  const CantileverMeasurement m = measure_cantilever(strip->clamp, strip->tip, strip->length);
  const double rigidity =
      part.fabric.areal_density * gravity * m.bending_length * m.bending_length * m.bending_length;
  return {{"droop_m", m.droop},
          {"chord_angle_degrees", m.chord_angle},
          {"bending_length_m", m.bending_length},
          {"bending_rigidity_n_m", rigidity},
          {"largest_speed_m_s", largest_speed(part, v)}};
}

}  // namespace

template <class Real>
std::vector<NamedNumber> measurements(TextileTest test, const ClothModel<Real>& model,
                                      const ClothState<Real>& state, const Vec3Array<Real>& v,
                                      double gravity, const Swing& swing) {
  assert(!model.parts.empty() && gravity >= 0);
  assert(state.inverse_mass.size() == model.mass.size() && v.size() == model.mass.size());
  if (test == TextileTest::drape) return drape(model, state, v);
  if (test == TextileTest::cantilever) return cantilever(model, state, v, gravity);
  if (test == TextileTest::decay) return decay(model, state, swing);
  return {};
}

template <class Real>
std::optional<double> deflection(const ClothModel<Real>& model, const ClothState<Real>& state) {
  const std::optional<Strip> strip = strip_of(model, state);
  if (!strip) return std::nullopt;
  const ClothPart<Real>& part = model.parts.front();
  const auto corner = [&](int row, int column) {
    const auto i = static_cast<std::size_t>(part.particles.first + row * part.columns + column);
    return model.rest_positions[i].template cast<double>().eval();
  };
  const Vec3d origin = corner(0, 0);
  const Vec3d normal = (corner(part.rows - 1, 0) - origin).cross(corner(0, 1) - origin);
  return (strip->tip - strip->clamp).dot(normal.normalized());
}

#define WEFT_INSTANTIATE(Real)                                                                    \
  template std::vector<NamedNumber> measurements(TextileTest, const ClothModel<Real>&,            \
                                                 const ClothState<Real>&, const Vec3Array<Real>&, \
                                                 double, const Swing&);                           \
  template std::optional<double> deflection(const ClothModel<Real>&, const ClothState<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
