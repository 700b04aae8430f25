#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/world/world.h"

namespace weft::bench {

// The worst cases of contact, and what should cost next to nothing: made by code, so that two
// versions of core can be timed on them. Only what both have is used here.

/// A hand that holds a particle.
struct CaseHand {
  /// The particle farthest in this direction where the case begins.
  Vec3d direction = Vec3d::UnitX();
  double stiffness = 1000, max_force = 50;  ///< [N/m], [N]
  /// Where it is after a time, from where it took hold [m, s].
  std::function<Vec3d(double)> path;
};

/// A stretch of motion whose ticks are timed.
struct ContactCase {
  std::string name, how;  ///< how: in words
  WorldDef def;
  int before = 0;  ///< ticks until it begins
  int ticks = 0;   ///< that are timed
  /// Ticks after which it goes on from a recorded state, so that versions whose motion differs are
  /// timed on the same one; 0: only its start is recorded.
  int stretch = 0;
  std::vector<CaseHand> hands = {};
};

/// All cases.
std::vector<ContactCase> contact_cases();

}  // namespace weft::bench
