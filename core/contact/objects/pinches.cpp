// Finds single layers of cloth between an object that comes and another object.

#include "core/contact/objects/pinches.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/objects/constants.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Two sides differ in flatness by less [1].
constexpr double kAlike = 1e-4;

/// First touch of a particle that has none yet.
constexpr Index kNoTouch = kNone - 1;

bool may_pinch(const ColliderState& collider) {
  return collider.is_active() && !collider.forced;
}

template <class Real>
Real gap_of(const ContactRow<Real>& row, const Vec3Array<Real>& x) {
  return row.normal.dot(weighted(row, x)) - row.offset;
}

/// Whether a row is near enough to be one side of a pinch: the other one may have been pressed into
/// the thickness, and lets go only slowly.
template <class Real>
bool is_near(const ContactRow<Real>& row, const Vec3Array<Real>& x) {
  return row.responds && gap_of(row, x) < row.thickness * Real(2);
}

/// Whether a layer between two objects has no room.
/// @param lack  what it lacks of its thickness on both sides [m]
template <class Real>
bool is_pinched(Real lack, Real thickness) {
  return lack > -(thickness * Real(kSqueezed) + Real(kTouchSlack));
}

/// Lists the rows of objects that come, as far as they are near, and their particles.
template <class Real>
void list_fronts(const ObjectRows<Real>& rows, const Vec3Array<Real>& x,
                 const ColliderStates& colliders, Pinches& pinches) {
  pinches.first_touch.resize(x.size(), kNone);
  for (const MovingRow<Real>& moving : rows.moving) {
    if (!may_pinch(colliders[moving.collider])) continue;
    const ContactRow<Real>& row = rows.all[moving.row];
    if (!is_near(row, x)) continue;
    pinches.fronts.push_back({moving.row, moving.collider, moving.collider});
    for (std::size_t k = 0; k < row.count; ++k) {
      Index& first = pinches.first_touch[at_index(row.particle[k])];
      if (first != kNone) continue;
      first = kNoTouch;
      pinches.particles.push_back(row.particle[k]);
    }
  }
}

/// Lists what is near the particles of `fronts`. Jaws that hold cloth press it on each other alone.
template <class Real>
void list_touches(const ObjectRows<Real>& rows, const Vec3Array<Real>& x,
                  const ColliderStates& colliders, Pinches& pinches) {
  for (std::size_t r = 0; r < rows.all.size(); ++r) {
    const ContactRow<Real>& row = rows.all[r];
    const auto is_of_front = [&](std::size_t k) {
      return pinches.first_touch[at_index(row.particle[k])] != kNone;
    };
    if (!is_of_front(0) && !(row.count > 1 && is_of_front(1)) && !(row.count > 2 && is_of_front(2)))
      continue;
    const ColliderState& other = colliders[at_index(row.collider)];
    if (other.grips() || !is_near(row, x)) continue;
    for (std::size_t k = 0; k < row.count; ++k) {
      if (!is_of_front(k)) continue;
      Index& first = pinches.first_touch[at_index(row.particle[k])];
      pinches.touches.push_back({r, first});
      first = static_cast<Index>(pinches.touches.size()) - 1;
    }
  }
}

/// Whether another object is behind each particle that carries a row of an object that comes. Adds
/// the rows of these others. Of jaws the other one is none: what both have in front of them is the
/// gripper's own affair.
/// @param mate  of a jaw, the other one; kNone: the object is none
/// @param lack  set to what the layer lacks of its thickness at the row's point [m]
template <class Real>
bool is_backed(const ObjectRows<Real>& rows, const Vec3Array<Real>& x, Index mate, PinchRow& front,
               Pinches& pinches, Real& lack) {
  const ContactRow<Real>& row = rows.all[front.row];
  Real behind = 0, weights = 0;
  const std::size_t known = pinches.backs.size();
  for (std::size_t k = 0; k < row.count; ++k) {
    if (!(row.weight[k] > Real(kCarries))) continue;
    Real most = std::numeric_limits<Real>::lowest();  // that this particle lacks behind it
    Index at = pinches.first_touch[at_index(row.particle[k])];
    for (; at != kNoTouch; at = pinches.touches[at_index(at)].next) {
      const std::size_t r = pinches.touches[at_index(at)].row;
      const ContactRow<Real>& other = rows.all[r];
      if (other.collider == row.collider || other.collider == mate) continue;
      if (!(other.normal.dot(row.normal) < -Real(kFacing))) continue;
      pinches.backs.push_back({r, front.object, front.object});
      front.other = at_index(other.collider);
      most = std::max(most, other.thickness - gap_of(other, x));
    }
    if (most == std::numeric_limits<Real>::lowest()) {
      pinches.backs.resize(known);
      return false;
    }
    behind += row.weight[k] * most;
    weights += row.weight[k];
  }
  assert(weights > 0 && "one of three particles carries a third");
  lack = behind / weights + row.thickness - gap_of(row, x);
  if (is_pinched(lack, row.thickness)) return true;
  pinches.backs.resize(known);
  return false;
}

/// Mean normal of the rows on one side of what object `k` pinches.
template <class Real>
Vec3d mean_normal(std::size_t k, const ObjectRows<Real>& rows, const std::vector<PinchRow>& side) {
  Vec3d sum = Vec3d::Zero();
  int count = 0;
  for (const PinchRow& pinch : side) {
    if (pinch.object != k) continue;
    sum += rows.all[pinch.row].normal.template cast<double>();
    ++count;
  }
  assert(count > 0);
  return sum / count;
}

/// Adds up where the rows of each object face.
template <class Real>
void sum_facing(const ObjectRows<Real>& rows, std::size_t objects, Pinches& pinches) {
  pinches.facing.assign(objects, {});
  for (const ContactRow<Real>& row : rows.all) {
    Pinches::Facing& facing = pinches.facing[at_index(row.collider)];
    facing.normals += row.normal.template cast<double>();
    ++facing.rows;
  }
}

/// How flat an object is where cloth is near: squared length of the mean of all its rows' normals,
/// 0..1. The few rows that touch would not tell: one alone is always flat.
double flatness(const Pinches::Facing& facing) {
  assert(facing.rows > 0);
  return (facing.normals / facing.rows).squaredNorm();
}

/// Direction in which object `k` presses what it pinches against `other`: across the flatter of
/// both sides, unit. Across the other one it would slide off to a side. Of sides alike it is the
/// one that it comes towards.
template <class Real>
Vec3d direction_of(std::size_t k, std::size_t other, const Vec3d& wanted,
                   const ObjectRows<Real>& rows, const Pinches& pinches) {
  const Vec3d front = mean_normal(k, rows, pinches.fronts).normalized();
  const Vec3d back = -mean_normal(k, rows, pinches.backs).normalized();
  const double before = flatness(pinches.facing[k]), behind = flatness(pinches.facing[other]);
  if (std::abs(before - behind) > kAlike) return before < behind ? back : front;
  return wanted.dot(front) < wanted.dot(back) ? back : front;
}

/// Removes rows that several particles have brought.
void remove_doubles(std::vector<PinchRow>& rows) {
  const auto key = [](const PinchRow& r) { return std::pair(r.object, r.row); };
  std::sort(rows.begin(), rows.end(),
            [&key](const PinchRow& a, const PinchRow& b) { return key(a) < key(b); });
  const auto same = [&key](const PinchRow& a, const PinchRow& b) { return key(a) == key(b); };
  rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end());
}

}  // namespace

template <class Real>
void find_pinches(const ObjectRows<Real>& rows, const Vec3Array<Real>& x,
                  ObjectMotion<Real>& motion, Pinches& pinches) {
  assert(motion.colliders);
  ColliderStates& colliders = *motion.colliders;
  // What was pinched earlier in this tick counts as pinched if it lets go for some substeps.
  constexpr double kUnknown = std::numeric_limits<double>::lowest();
  for (ColliderState& collider : colliders) collider.pinch.lack = kUnknown;
  for (const Index i : pinches.particles) pinches.first_touch[at_index(i)] = kNone;
  pinches.particles.clear();
  pinches.fronts.clear();
  pinches.backs.clear();
  pinches.touches.clear();
  list_fronts(rows, x, colliders, pinches);
  if (!pinches.fronts.empty()) list_touches(rows, x, colliders, pinches);
  std::size_t backed = 0;
  for (std::size_t n = 0; n < pinches.fronts.size(); ++n) {
    PinchRow& front = pinches.fronts[n];
    Real lack = 0;
    if (!is_backed(rows, x, colliders[front.object].mate, front, pinches, lack)) continue;
    ColliderState& object = colliders[front.object];
    object.pinch.lack = std::max(object.pinch.lack, static_cast<double>(lack));
    object.pinch.other = static_cast<Index>(front.other);
    pinches.fronts[backed++] = front;
  }
  pinches.fronts.resize(backed);
  remove_doubles(pinches.backs);
  for (const PinchRow& back : pinches.backs)
    colliders[at_index(rows.all[back.row].collider)].pinch.braces = true;
  if (backed > 0) sum_facing(rows, colliders.size(), pinches);
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    const Vec3d& wanted = colliders[k].wanted.linear;
    Pinch& pinch = colliders[k].pinch;
    if (pinch.lack == kUnknown)
      pinch.lack = 0;
    else
      pinch.direction = direction_of(k, at_index(pinch.other), wanted, rows, pinches);
  }
}

WEFT_INSTANTIATE_FUNCTIONS(find_pinches)

}  // namespace weft
