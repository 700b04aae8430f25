// Sums forces at fixed particles over a tick, from the elements that touch them.

#include "core/solver/held_forces.h"

#include <algorithm>
#include <span>

#include "core/cloth/bending_stencil.h"
#include "core/forces/force_pass.h"
#include "core/forces/rest_curve.h"
#include "core/forces/stencil_force.h"
#include "core/solver/verlet.h"

namespace weft {
namespace {

/// Copies the elements of a range that are `wanted`, and returns their range in `to`.
template <class Element, class Wanted>
IndexRange take(const std::vector<Element>& from, const IndexRange& range, const Wanted& wanted,
                std::vector<Element>& to) {
  const auto first = static_cast<Index>(to.size());
  for (Index n = range.first; n < range.end(); ++n) {
    const Element& element = from[static_cast<std::size_t>(n)];
    if (wanted(element)) to.push_back(element);
  }
  return {first, static_cast<Index>(to.size()) - first};
}

/// A range of a list.
template <class Element>
std::span<const Element> elements_of(const std::vector<Element>& list, const IndexRange& range) {
  return std::span(list).subspan(static_cast<std::size_t>(range.first),
                                 static_cast<std::size_t>(range.count));
}

/// The rest curves of the triangles whose curvature has a particle of some kind.
template <class Real, class Wanted>
RestCurves<Real> curves_with(const RestCurves<Real>& all, Wanted&& wanted) {
  RestCurves<Real> some;
  some.begin.push_back(0);
  for (std::size_t t = 0; t < all.triangles.size(); ++t) {
    const auto begin = static_cast<std::ptrdiff_t>(all.begin[t]),
               end = static_cast<std::ptrdiff_t>(all.begin[t + 1]);
    if (!std::any_of(all.particles.begin() + begin, all.particles.begin() + end, wanted)) continue;
    some.triangles.push_back(all.triangles[t]);
    some.smallest_cross.push_back(all.smallest_cross[t]);
    some.particles.insert(some.particles.end(), all.particles.begin() + begin,
                          all.particles.begin() + end);
    some.pulls.insert(some.pulls.end(), all.pulls.begin() + begin, all.pulls.begin() + end);
    some.begin.push_back(some.particles.size());
  }
  return some;
}

/// The cells of a grid that have a particle of some kind, cut out with the rows and columns between
/// them, so that a substep does not go over all others.
template <class Wanted>
GridCells cells_with(const GridCells& all, Wanted&& wanted) {
  const auto chosen = [&](int r, int c) {
    return all.has_cell(r, c) &&
           (wanted(all.particle(r, c)) || wanted(all.particle(r, c + 1)) ||
            wanted(all.particle(r + 1, c)) || wanted(all.particle(r + 1, c + 1)));
  };
  int top = all.rows, bottom = -1, left = all.columns, right = -1;
  for (int r = 0; r + 1 < all.rows; ++r) {
    for (int c = 0; c + 1 < all.columns; ++c) {
      if (!chosen(r, c)) continue;
      top = std::min(top, r);
      bottom = std::max(bottom, r);
      left = std::min(left, c);
      right = std::max(right, c);
    }
  }
  GridCells cut;
  if (bottom < 0) return cut;
  cut.rows = bottom - top + 2;
  cut.columns = right - left + 2;
  for (int r = top; r <= bottom + 1; ++r) {
    for (int c = left; c <= right + 1; ++c) {
      cut.particles.push_back(all.particle(r, c));
      if (r <= bottom && c <= right) cut.kept.push_back(chosen(r, c) ? 1 : 0);
    }
  }
  return cut;
}

}  // namespace

template <class Real>
void HeldForces<Real>::Stencils::clear() {
  stiffness.clear();
  weights.clear();
  corners.clear();
  begin.assign(1, 0);
  first_of_part.assign(1, 0);
}

template <class Real>
void HeldForces<Real>::Stencils::add(double k, const Index* corner, const double* weight,
                                     int count) {
  stiffness.push_back(k);
  corners.insert(corners.end(), corner, corner + count);
  weights.insert(weights.end(), weight, weight + count);
  begin.push_back(corners.size());
}

template <class Real>
template <class Visit>
void HeldForces<Real>::Stencils::visit(std::size_t part, Visit&& visit) const {
  for (std::size_t s = first_of_part[part]; s < first_of_part[part + 1]; ++s) {
    visit(stiffness[s], StencilView{corners.data() + begin[s], weights.data() + begin[s],
                                    static_cast<int>(begin[s + 1] - begin[s])});
  }
}

template <class Real>
void HeldForces<Real>::begin_tick(const ClothModel<Real>& model, const Pins& pins) {
  found_.clear();
  for (const Pin& pin : pins.list) {
    if (!pin.path) found_.insert(found_.end(), pin.particles.begin(), pin.particles.end());
  }
  if (stale_ || found_ != held_) {
    held_ = found_;
    list(model);
  }
  std::fill(force_.begin(), force_.end(), Vec3<Real>::Zero());
  std::fill(impulse_.begin(), impulse_.end(), Vec3d::Zero());
  keep();
}

/// Lists the elements that have a fixed particle.
template <class Real>
void HeldForces<Real>::list(const ClothModel<Real>& model) {
  place_.assign(model.mass.size(), kNone);
  force_.resize(model.mass.size());
  impulse_.clear();
  for (const Index i : held_) {
    Index& place = place_[static_cast<std::size_t>(i)];
    if (place != kNone) continue;  // several pins hold it
    place = static_cast<Index>(impulse_.size());
    impulse_.push_back(Vec3d::Zero());
  }
  near_.parts.resize(model.parts.size());
  near_.springs.clear();
  near_.membrane.clear();
  near_.locks.clear();
  near_.hinges.clear();
  near_.triangles.clear();
  bending_.clear();
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    ClothPart<Real>& part = near_.parts[p];
    part.particles = model.parts[p].particles;
    part.fabric = model.parts[p].fabric;
    part.membrane_tensor = model.parts[p].membrane_tensor;
    list_part(model, model.parts[p]);
  }
  seen_.resize(model.parts.size());
  for (std::size_t p = 0; p < model.parts.size(); ++p) list_seen(p);
  stale_ = false;
}

template <class Real>
void HeldForces<Real>::list_seen(std::size_t part) {
  const ClothPart<Real>& near = near_.parts[part];
  std::vector<Index>& seen = seen_[part];
  seen.clear();
  const auto note = [&seen](const Index* particles, std::size_t count) {
    seen.insert(seen.end(), particles, particles + count);
  };
  for (const Spring<Real>& s : elements_of(near_.springs, near.springs))
    seen.insert(seen.end(), {s.i, s.j});
  for (const auto& t : elements_of(near_.membrane, near.membrane)) note(&t.x[0], 3);
  for (const auto& t : elements_of(near_.locks, near.locks)) note(&t.x[0], 3);
  for (const auto& h : elements_of(near_.hinges, near.hinges)) note(&h.x[0], 4);
  for (const auto& t : elements_of(near_.triangles, near.triangles)) note(&t[0], 3);
  bending_.visit(part, [&](double, const StencilView& stencil) {
    note(stencil.corners, static_cast<std::size_t>(stencil.count));
  });
  const auto note_own = [&](Index i) { seen.push_back(near.particles.first + i); };
  for (const Triangle& t : near.rest_curves.triangles) std::for_each(t.begin(), t.end(), note_own);
  for (const Index i : near.rest_curves.particles) note_own(i);
  for (int r = 0; r + 1 < near.cells.rows; ++r) {
    for (int c = 0; c + 1 < near.cells.columns; ++c) {
      if (!near.cells.has_cell(r, c)) continue;
      for (int k = 0; k < 4; ++k) note_own(near.cells.particle(r + k / 2, c + k % 2));
    }
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
}

template <class Real>
bool HeldForces<Real>::touches(const Index* particles, std::size_t count) const {
  return std::any_of(particles, particles + count, [this](Index i) { return holds(i); });
}

template <class Real>
void HeldForces<Real>::list_part(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  ClothPart<Real>& near = near_.parts[static_cast<std::size_t>(&part - model.parts.data())];
  near.springs = take(
      model.springs, part.springs, [this](const auto& s) { return holds(s.i) || holds(s.j); },
      near_.springs);
  near.membrane = take(
      model.membrane, part.membrane, [this](const auto& t) { return touches(&t.x[0], 3); },
      near_.membrane);
  near.locks = take(
      model.locks, part.locks, [this](const auto& t) { return touches(&t.x[0], 3); }, near_.locks);
  near.hinges = take(
      model.hinges, part.hinges, [this](const auto& h) { return touches(&h.x[0], 4); },
      near_.hinges);
  near.triangles = take(
      model.triangles, part.triangles, [this](const auto& t) { return touches(&t[0], 3); },
      near_.triangles);
  near.rest_curves =
      curves_with(part.rest_curves, [&](Index i) { return holds(part.particles.first + i); });
  near.grid_springs = part.grid_springs;
  if (part.grid_springs)
    near.cells = cells_with(part.cells, [&](Index i) { return holds(part.particles.first + i); });
  const auto adder = [this](Stencils& list) {
    return [this, &list](double k, const Index* corners, const double* weights, int count) {
      if (touches(corners, static_cast<std::size_t>(count))) list.add(k, corners, weights, count);
    };
  };
  visit_bending_stencils(part, adder(bending_));
  bending_.first_of_part.push_back(bending_.stiffness.size());
}

template <class Real>
void HeldForces<Real>::act(std::size_t part, const Surroundings<Real>& around,
                           const Vec3Array<Real>& x, const Vec3Array<Real>& v, double seconds) {
  assert(!stale_ && "begin_tick comes first");
  assert(seconds >= 0 && x.size() == force_.size() && v.size() == force_.size());
  const ClothPart<Real>& near = near_.parts[part];
  add_spring_forces(near_, near, x, v, force_);
  add_membrane_forces(near_, near, x, v, force_);
  add_locking_forces(near_, near, x, force_);
  add_hinge_forces(near_, near, x, v, force_);
  add_rest_curve_forces(near, x, force_);
  bending_.visit(part, [&](double k, const StencilView& stencil) {
    add_stencil_force(k, stencil, x, force_);
  });
  if (around.air) add_air_forces(near_, near, around.wind, around.air_density, x, v, force_);
  for (const Index i : held_) {
    Vec3<Real>& force = force_[static_cast<std::size_t>(i)];
    if (!near.particles.contains(i)) continue;
    push(i, force.template cast<double>() * seconds);
    force.setZero();
  }
}

template <class Real>
void HeldForces<Real>::act(const Surroundings<Real>& around, const Vec3Array<Real>& x,
                           const Vec3Array<Real>& v, double seconds) {
  for (std::size_t p = 0; p < near_.parts.size(); ++p) act(p, around, x, v, seconds);
}

template <class Real>
void HeldForces<Real>::pull(const Grabs<Real>& grabs, double seconds) {
  const auto give = [this](Index i, const Vec3<Real>& impulse) {
    if (holds(i)) push(i, impulse.template cast<double>());
  };
  for (const Grab<Real>& grab : grabs.list) {
    if (grab.def.mode != GrabMode::live) continue;
    for (std::size_t n = 0; n < grab.particles.size(); ++n)
      give(grab.particles[n], grab.impulse[n]);
  }
  for (const SlingImpulse<Real>& sling : grabs.impulses) {
    for (std::size_t n = 0; n < sling.particles.size(); ++n)
      give(sling.particles[n], sling.force * (sling.weights[n] * static_cast<Real>(seconds)));
  }
}

template class HeldForces<float>;
template class HeldForces<double>;

}  // namespace weft
