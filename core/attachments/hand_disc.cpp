// Finds the particles that a hand holds, and their weights.

#include "core/attachments/hand_disc.h"

#include <array>
#include <cassert>

#include "core/cloth/corner_places.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Smooth weights over the disc around the hit, scaled by mass, so that the disc is accelerated
/// uniformly.
template <class Real>
void weigh_disc(const ClothModel<Real>& model, const GrabDef& def, Grab<Real>& grab) {
  assert(def.radius > 0);
  const CornerUv corners = corner_places(model, def.triangle);
  double u = 0, v = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    u += def.barycentric[k] * corners[k][0];
    v += def.barycentric[k] * corners[k][1];
  }
  const auto inside = [&](Index i) {
    const auto& place = model.material[at_index(i)];
    const double du = static_cast<double>(place[0]) - u, dv = static_cast<double>(place[1]) - v;
    return 1 - (du * du + dv * dv) / (def.radius * def.radius);
  };
  const Triangle& hit = model.triangles[at_index(def.triangle)];
  double sum = 0;
  std::vector<double> weights;
  // What lies on the circle weighs nothing.
  const double least = 2 * disc_slack({u, v}, def.radius) / def.radius;
  for (const Index i : joined_near(model, hit, [&](Index k) { return inside(k) > least; })) {
    grab.particles.push_back(i);
    const double part = inside(i);
    weights.push_back(part * part * static_cast<double>(model.mass[at_index(i)]));
    sum += weights.back();
  }
  assert(weights.empty() || sum > 0);
  for (const double w : weights) grab.weights.push_back(static_cast<Real>(w / sum));
}

template <class Real>
void weigh_corners(const ClothModel<Real>& model, const GrabDef& def, Grab<Real>& grab) {
  const Triangle& corners = model.triangles[at_index(def.triangle)];
  for (std::size_t k = 0; k < 3; ++k) {
    grab.particles.push_back(corners[k]);
    grab.weights.push_back(static_cast<Real>(def.barycentric[k]));
  }
}

}  // namespace

template <class Real>
void weigh_hold(const ClothModel<Real>& model, const GrabDef& def, Grab<Real>& grab) {
  assert(grab.particles.empty() && grab.weights.empty());
  if (def.radius > 0) weigh_disc(model, def, grab);
  if (grab.particles.empty()) weigh_corners(model, def, grab);
}

WEFT_INSTANTIATE_FUNCTIONS(weigh_hold)

}  // namespace weft
