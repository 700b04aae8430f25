// Finds islands of touching cloths, puts them to sleep and wakes them.

#include "core/world/sleep.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/contact/objects/cloth_patches.h"
#include "core/world/constants.h"

namespace weft {

template <class Real>
Sleep<Real>::Sleep(const ClothModel<Real>& model, const SleepDef& def, double tick_seconds,
                   bool together)
    : def_(def), tick_seconds_(static_cast<Real>(tick_seconds)),
      ticks_(static_cast<std::uint32_t>(std::max(1L, std::lround(def.after / tick_seconds)))),
      together_(together), mass_(model.mass) {
  assert(tick_seconds > 0);
  const std::size_t parts = model.parts.size();
  asleep_.assign(parts, 0);
  disturbed_.assign(parts, 0);
  still_ticks_.assign(parts, 0);
  for (std::size_t p = 0; p < parts; ++p) island_.push_back(p);
  if (!wanted()) return;
  place_ = model.rest_positions;
  boxes_.resize(parts);
  for (std::size_t p = 0; p < parts; ++p) {
    const ClothPart<Real>& part = model.parts[p];
    particles_.push_back(part.particles);
    margin_.push_back(static_cast<Real>(part.fabric.thickness));
    const auto first = model.rest_positions.begin() + part.particles.first;
    const Vec3Array<Real> positions(first, first + part.particles.count);
    std::vector<Triangle> triangles(
        model.triangles.begin() + part.triangles.first,
        model.triangles.begin() + part.triangles.first + part.triangles.count);
    for (Triangle& t : triangles) {
      for (Index& i : t) i -= part.particles.first;
    }
    const ClothPatches patches = make_patches(positions, {}, triangles);
    Boxes& boxes = boxes_[p];
    for (const ClothPatch& patch : patches.list) {
      std::vector<Index>& list = boxes.patches.emplace_back();
      for (Index t = patch.triangles.first; t < patch.triangles.end(); ++t) {
        for (const Index i : patches.triangles[static_cast<std::size_t>(t)])
          list.push_back(i + part.particles.first);
      }
      for (Index k = patch.particles.first; k < patch.particles.end(); ++k)
        list.push_back(patches.particles[static_cast<std::size_t>(k)] + part.particles.first);
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      Aabb<Real> box;
      for (const Index i : list) box.add(model.rest_positions[static_cast<std::size_t>(i)]);
      boxes.list.push_back(box);
    }
    boxes.tree.build(boxes.list);
  }
}

template <class Real>
bool Sleep<Real>::any_asleep() const {
  return std::any_of(asleep_.begin(), asleep_.end(), [](char a) { return a != 0; });
}

template <class Real>
bool Sleep<Real>::all_asleep() const {
  return std::all_of(asleep_.begin(), asleep_.end(), [](char a) { return a != 0; });
}

template <class Real>
void Sleep<Real>::disturb_all() {
  std::fill(disturbed_.begin(), disturbed_.end(), char{1});
}

/// Extends a box by a particle's present position and its positions in the coming ticks.
template <class Real>
void Sleep<Real>::add_coming(Index particle, const ClothState<Real>& state, Aabb<Real>& box) const {
  const auto k = static_cast<std::size_t>(particle);
  box.add(state.x[k]);
  box.add(state.x[k] + state.v[k] * (tick_seconds_ * Real(kSleepTicksAhead)));
}

template <class Real>
void Sleep<Real>::enclose(std::size_t part, const ClothState<Real>& state) {
  assert(part < particles_.size());
  const IndexRange& all = particles_[part];
  Aabb<Real> box;
  for (Index i = all.first; i < all.end(); ++i) add_coming(i, state, box);
  boxes_[part].whole = box.grown(margin_[part]);
  boxes_[part].fitted = false;
}

template <class Real>
void Sleep<Real>::fit(std::size_t part, const ClothState<Real>& state) {
  assert(part < boxes_.size());
  Boxes& boxes = boxes_[part];
  if (boxes.fitted) return;
  for (std::size_t k = 0; k < boxes.patches.size(); ++k) {
    Aabb<Real> box;
    for (const Index i : boxes.patches[k]) add_coming(i, state, box);
    boxes.list[k] = box.grown(margin_[part]);
  }
  boxes.tree.refit(boxes.list);
  boxes.fitted = true;
}

/// Whether two cloths could touch in the coming ticks, judged by boxes around a few triangles.
template <class Real>
bool Sleep<Real>::could_touch(std::size_t a, std::size_t b, const ClothState<Real>& state) {
  if (together_) return true;
  if (!boxes_[a].whole.overlaps(boxes_[b].whole)) return false;
  fit(a, state);
  fit(b, state);
  bool touch = false;
  for (const Aabb<Real>& box : boxes_[a].list) {
    boxes_[b].tree.for_each_overlap(box, [&touch](Index) { touch = true; });
    if (touch) return true;
  }
  return false;
}

template <class Real>
void Sleep<Real>::disturb_near(const ClothState<Real>& state, const ColliderDef& def,
                               const ColliderState& collider) {
  assert(wanted());
  const double radius = radius_of(def.shape);
  if (!std::isfinite(radius)) return disturb_all();
  Aabb<Real> reach;
  const double ahead = static_cast<double>(tick_seconds_) * kSleepTicksAhead;
  for (const Vec3d& p : {collider.start.position, collider.goal.position,
                         Vec3d(collider.start.position + collider.wanted.linear * ahead)})
    reach.add(p.cast<Real>());
  reach = reach.grown(static_cast<Real>(radius));
  for (std::size_t p = 0; p < asleep_.size(); ++p) {
    if (disturbed_[p] || !boxes_[p].whole.overlaps(reach)) continue;
    fit(p, state);
    boxes_[p].tree.for_each_overlap(reach, [&](Index) { disturbed_[p] = 1; });
  }
}

template <class Real>
void Sleep<Real>::begin_stillness(std::size_t part, const ClothState<Real>& state) {
  const IndexRange& range = particles_[part];
  std::copy_n(state.x.begin() + range.first, range.count, place_.begin() + range.first);
  still_ticks_[part] = 0;
}

/// Restores the masses of a cloth.
template <class Real>
void Sleep<Real>::wake_cloth(std::size_t part, const Pins& pins, ClothState<Real>& state) {
  begin_stillness(part, state);
  if (!std::exchange(asleep_[part], char{0})) return;
  if (any_asleep())
    state.asleep = asleep_;
  else
    state.asleep.clear();
  for (Index i = particles_[part].first; i < particles_[part].end(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!is_fixed(pins, i)) state.inverse_mass[k] = Real(1) / mass_[k];
  }
}

template <class Real>
void Sleep<Real>::wake(std::size_t part, const Pins& pins, ClothState<Real>& state) {
  if (!wanted()) return;
  assert(state.x.size() == mass_.size() && state.inverse_mass.size() == mass_.size());
  const bool slept = is_asleep(part);
  const std::size_t island = island_[part];
  wake_cloth(part, pins, state);
  for (std::size_t p = 0; p < asleep_.size(); ++p) {
    if (slept && is_asleep(p) && island_[p] == island) wake_cloth(p, pins, state);
  }
}

template <class Real>
void Sleep<Real>::wake_all(const Pins& pins, ClothState<Real>& state) {
  if (!wanted()) return;
  for (std::size_t p = 0; p < asleep_.size(); ++p) wake_cloth(p, pins, state);
}

template <class Real>
bool Sleep<Real>::rouse(const Pins& pins, ClothState<Real>& state) {
  if (!any_asleep()) return false;
  bool any = false;
  const auto wake_up = [&](std::size_t p) {
    wake(p, pins, state);
    any = true;
  };
  for (std::size_t p = 0; p < asleep_.size(); ++p) {
    if (is_asleep(p) && disturbed_[p]) wake_up(p);
  }
  // A woken cloth may wake others in turn.
  for (bool again = !all_asleep(); again;) {
    again = false;
    for (std::size_t p = 0; p < asleep_.size(); ++p) {
      if (!is_asleep(p)) continue;
      for (std::size_t q = 0; q < asleep_.size() && is_asleep(p); ++q) {
        if (is_asleep(q) || !could_touch(p, q, state)) continue;
        wake_up(p);
        again = true;
      }
    }
  }
  return any;
}

template <class Real>
bool Sleep<Real>::has_left(std::size_t part, const ClothState<Real>& state) const {
  const auto most = static_cast<Real>(def_.distance * def_.distance);
  for (Index i = particles_[part].first; i < particles_[part].end(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!((state.x[k] - place_[k]).squaredNorm() <= most)) return true;
  }
  return false;
}

/// Numbers the islands of awake cloths by the first cloth of each.
template <class Real>
void Sleep<Real>::find_islands(const ClothState<Real>& state) {
  const std::size_t parts = asleep_.size();
  for (std::size_t p = 0; p < parts; ++p) {
    if (!is_asleep(p)) island_[p] = p;
  }
  for (std::size_t p = 0; p < parts; ++p) {
    if (is_asleep(p)) continue;
    for (std::size_t q = 0; q < p; ++q) {
      if (is_asleep(q) || island_[p] == island_[q] || !could_touch(p, q, state)) continue;
      const auto [first, second] = std::minmax(island_[p], island_[q]);
      const std::size_t low = first, high = second;
      for (std::size_t r = 0; r <= p; ++r) {
        if (!is_asleep(r) && island_[r] == high) island_[r] = low;
      }
    }
  }
}

template <class Real>
bool Sleep<Real>::settle(ClothState<Real>& state) {
  if (!wanted()) return false;
  assert(state.x.size() == mass_.size() && state.v.size() == mass_.size());
  const std::size_t parts = asleep_.size();
  bool any_ready = false;
  for (std::size_t p = 0; p < parts; ++p) {
    const bool disturbed = std::exchange(disturbed_[p], char{0}) != 0;
    if (is_asleep(p)) continue;
    enclose(p, state);
    if (disturbed || has_left(p, state))
      begin_stillness(p, state);
    else
      any_ready |= ++still_ticks_[p] >= ticks_;
  }
  if (!any_ready) return false;
  find_islands(state);
  bool any = false;
  for (std::size_t island = 0; island < parts; ++island) {
    if (is_asleep(island) || island_[island] != island) continue;
    bool ready = true;
    for (std::size_t p = island; p < parts; ++p)
      ready = ready && (is_asleep(p) || island_[p] != island || still_ticks_[p] >= ticks_);
    if (!ready) continue;
    for (std::size_t p = island; p < parts; ++p) {
      if (is_asleep(p) || island_[p] != island) continue;
      for (Index i = particles_[p].first; i < particles_[p].end(); ++i) {
        state.v[static_cast<std::size_t>(i)].setZero();
        state.inverse_mass[static_cast<std::size_t>(i)] = 0;
      }
      asleep_[p] = 1;
      state.asleep = asleep_;
      enclose(p, state);
      any = true;
    }
  }
  return any;
}

template class Sleep<float>;
template class Sleep<double>;

}  // namespace weft
