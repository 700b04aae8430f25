// Sets up the guard for the cloths of a model, and lets it forget where they were.

#include "core/contact/guard/cloth_guard.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// Radius of the balls around predicted paths, as a part of the thickness, and the most of it as a
/// part of the edge length: beyond it all neighbours become pairs.
constexpr double kReachPart = 0.65, kMostReach = 0.28;

}  // namespace

template <class Real>
ClothGuard<Real>::ClothGuard(const ClothModel<Real>& model, Executor* executor)
    : executor_(executor), edges_(model.edges), triangles_(model.triangles),
      neighbours_(model.mass.size(), edges_), tree_(model), boxes_(tree_, edges_, triangles_),
      tangles_(model) {
  for (const Vec3<Real>& p : model.rest_positions) rest_positions_.push_back(to_quad(p));
  find_who_is_across();
  finest_ = std::numeric_limits<Real>::infinity();
  for (const ClothPart<Real>& part : model.parts) {
    particles_of_.push_back(part.particles);
    thickness_.push_back(static_cast<Real>(part.fabric.thickness));
    friction_.push_back(static_cast<Real>(part.fabric.friction));
    thickest_ = std::max(thickest_, thickness_.back());
    double sum = 0;
    for (Index e = part.edges.first; e < part.edges.end(); ++e) {
      const Edge& edge = edges_[static_cast<std::size_t>(e)];
      sum += static_cast<double>((model.rest_positions[static_cast<std::size_t>(edge[0])] -
                                  model.rest_positions[static_cast<std::size_t>(edge[1])])
                                     .norm());
    }
    const double mean =
        part.rows > 0 ? std::min(static_cast<double>(part.cell_u), static_cast<double>(part.cell_v))
                      : 0.8 * sum / std::max<Index>(part.edges.count, 1);
    cell_.push_back(static_cast<Real>(mean));
    finest_ = std::min(finest_, cell_.back());
  }
  reach_ = std::min(thickest_ * Real(kReachPart), finest_ * Real(kMostReach));
  reach_ = std::max(reach_, finest_ * Real(0.1));
  calm_paths_.reach = reach_;
  const std::size_t n = model.mass.size();
  for (QuadArray<Real>* array : {&motion_.start, &motion_.end, &from_, &velocity_, &legal_, &step_,
                                 &anchor_, &x_rows_, &quad_v_, &extra_})
    array->assign(n, {});
  for (Vec3Array<Real>* array : {&calm_paths_.base, &calm_paths_.velocity, &ends_})
    array->assign(n, Vec3<Real>::Zero());
  in_rows_.assign(n, 0);
  is_moved_.assign(n, 0);
  first_row_.assign(n, kNone);
  is_active_.assign(n, 0);
  for (const ClothPart<Real>& part : model.parts) {
    for (Index i = part.particles.first; i < part.particles.end(); ++i)
      inverse_area_.push_back(static_cast<Real>(part.fabric.areal_density) /
                              model.mass[static_cast<std::size_t>(i)]);
  }
  for (std::vector<Real>* array : {&room_, &moved_, &since_, &step_length_, &pressure_})
    array->assign(n, Real(0));
  fraction_.assign(n, Real(1));
  wave_of_.assign(n, 0);
  anchored_at_.assign(n, 0);
  is_tight_.assign(n, 0);
  is_pushed_.assign(n, 0);
  searches_.resize(kMostParts);
  anchor_parts_.resize(kMostParts);
  row_parts_.resize(kMostParts);
  turn_parts_.resize(RowSlabs<Real>::kLists);
  resting_.assign(tree_.patch_count(), 0);
  is_heap_.assign(particles_of_.size(), 0);
  crossings_of_.assign(particles_of_.size(), 0);
  let_rest({});
}

template <class Real>
Index ClothGuard<Real>::part_of(Index particle) const {
  std::size_t part = particles_of_.size() - 1;
  while (part > 0 && particle < particles_of_[part].first) --part;
  return static_cast<Index>(part);
}

template <class Real>
void ClothGuard<Real>::reset() {
  collected_ = rows_built_ = false;
  forget_rows();
  arrived_.clear();
  passed_.clear();
  pairs_.clear();
  active_.clear();
  dirty_.clear();
  for (const Index i : pushed_) {
    extra_[static_cast<std::size_t>(i)] = {};
    is_pushed_[static_cast<std::size_t>(i)] = 0;
  }
  pushed_.clear();
  open_pairs_ = 0;
  tangles_.reset();
  is_heap_.assign(is_heap_.size(), 0);
  heaps_ = 0;
  unseen_ = true;
  kicked_ = 0;
  closed_ = true;
  upwards_ = false;
}

template <class Real>
void ClothGuard<Real>::let_rest(const std::vector<char>& asleep) {
  collected_ = rows_built_ = false;
  const auto sleeps = [&](std::size_t cloth) { return !asleep.empty() && asleep[cloth] != 0; };
  for (std::size_t p = 0; p < resting_.size(); ++p) {
    const Index particle = tree_.patch(static_cast<Index>(p)).particles.front();
    resting_[p] = sleeps(static_cast<std::size_t>(part_of(particle))) ? 1 : 0;
  }
  awake_.clear();
  awake_count_ = 0;
  for (std::size_t k = 0; k < particles_of_.size(); ++k) {
    if (sleeps(k)) continue;
    awake_.push_back(particles_of_[k]);
    awake_count_ += static_cast<std::size_t>(particles_of_[k].count);
  }
}

template <class Real>
PairPoints<Real> ClothGuard<Real>::points(const GuardedPair<Real>& pair,
                                          const QuadArray<Real>& x) const {
  PairPoints<Real> p;
  for (std::size_t k = 0; k < 4; ++k)
    p[k] = to_vector(x[static_cast<std::size_t>(pair.particle[k])]);
  return p;
}

template class ClothGuard<float>;
template class ClothGuard<double>;

}  // namespace weft
