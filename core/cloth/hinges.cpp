// Finds edges and hinges of triangles.

#include "core/cloth/hinges.h"

#include <cassert>
#include <cmath>

#include "core/cloth/constants.h"
#include "core/cloth/corner_places.h"
#include "core/geometry/hinge_angle.h"
#include "core/geometry/triangle_sides.h"

namespace weft {
namespace {

/// Rigidity over an edge in the fabric of one of its triangles [N m].
template <class Real>
double rigidity_at(const TriangleSide& side, const HingeSettings& settings,
                   const ClothModel<Real>& model) {
  const auto [a, b] = stored_ends(model, side);
  return settings.rigidity(std::abs(static_cast<double>(b[0]) - static_cast<double>(a[0])),
                           std::abs(static_cast<double>(b[1]) - static_cast<double>(a[1])));
}

template <class Real>
void add_hinge(const HingeSettings& settings, const TriangleSide& first, const TriangleSide& second,
               ClothModel<Real>& model) {
  assert(first.ends == second.ends && first.triangle != second.triangle);
  const double rigidity =
      (rigidity_at(first, settings, model) + rigidity_at(second, settings, model)) / 2;
  assert(rigidity >= 0);
  if (rigidity == 0) return;
  const Triangle& t1 = model.triangles[static_cast<std::size_t>(first.triangle)];
  const Triangle& t2 = model.triangles[static_cast<std::size_t>(second.triangle)];
  const auto corner = static_cast<std::size_t>(first.corner);
  Hinge<Real> hinge;
  hinge.x[0] = t1[(corner + 1) % 3];
  hinge.x[1] = t1[(corner + 2) % 3];
  hinge.x[2] = t1[corner];
  hinge.x[3] = t2[static_cast<std::size_t>(second.corner)];
  const double length2 = rest_length2(model, first, second);
  const double area =
      static_cast<double>(model.triangle_area[static_cast<std::size_t>(first.triangle)]) +
      static_cast<double>(model.triangle_area[static_cast<std::size_t>(second.triangle)]);
  assert(length2 > 0 && area > 0);
  hinge.stiffness = static_cast<Real>(rigidity * length2 / area);
  hinge.damping = static_cast<Real>(settings.damping) * hinge.stiffness;
  hinge.rest_angle = static_cast<Real>(settings.rest_angle);
  hinge.sine_form = settings.sine_form;
  if (settings.add_own_angle && !rests_by_triangle(model)) {
    const auto x = [&](std::size_t k) -> const Vec3<Real>& {
      return model.rest_positions[static_cast<std::size_t>(hinge.x[k])];
    };
    hinge.rest_angle += hinge_angle<Real>(x(0), x(1), x(2), x(3)).theta;
  }
  hinge.smallest_normal2 = static_cast<Real>(kCrumpledArea * kCrumpledArea * area * area);
  model.hinges.push_back(hinge);
}

}  // namespace

template <class Real>
void connect_triangles(const HingeSettings& settings, ClothModel<Real>& model) {
  assert(settings.rigidity && settings.damping >= 0);
  assert(model.material.size() == model.rest_positions.size());
  assert(model.triangle_area.size() == model.triangles.size());
  const std::vector<TriangleSide> sides = sorted_sides(model.triangles);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const TriangleSide& first = sides[s];
    model.edges.push_back(first.ends);
    if (s + 1 == sides.size() || sides[s + 1].ends != first.ends) continue;
    add_hinge(settings, first, sides[++s], model);
  }
}

template void connect_triangles(const HingeSettings&, ClothModel<float>&);
template void connect_triangles(const HingeSettings&, ClothModel<double>&);

}  // namespace weft
