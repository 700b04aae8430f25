#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/geometry/bvh.h"
#include "core/world/world.h"

namespace weft {

/// What is looked at after each tick of a hard case, and what it says in the end.
template <class Real>
class Verdict {
 public:
  /// To be called after each tick.
  void look(const World<Real>& world);

  std::uint64_t ticks = 0;
  std::uint64_t crossings = 0;        ///< of edges through triangles, over all ticks that count
  std::uint64_t crossed_ticks = 0;    ///< ticks that count with any of them
  std::uint64_t early_crossings = 0;  ///< before the ticks that count
  double deepest = 0;                 ///< into an object, in ticks that count [m]
  double smallest_gap = std::numeric_limits<double>::infinity();  ///< of contacts [m]
  double largest_strain = 0;
  double lost_motion = 0;  ///< truncated by wanted motion, of the guard
  std::uint64_t recoveries = 0;
  bool finite = true;

  /// What the case does not keep to, in words; nothing: it passes.
  std::vector<std::string> failures(const VerdictDef& def) const;

 private:
  std::uint64_t count_crossings_of(const World<Real>& world);

  Bvh<double> tree_;
};

extern template class Verdict<float>;
extern template class Verdict<double>;

}  // namespace weft
