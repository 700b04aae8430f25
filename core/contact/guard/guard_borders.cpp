// Which of the triangles that a particle is near to carries it.

#include <algorithm>

#include "core/contact/guard/cloth_guard.h"
#include "core/geometry/triangle_sides.h"

namespace weft {

/// Who is across each edge of a triangle.
template <class Real>
void ClothGuard<Real>::find_who_is_across() {
  across_.assign(triangles_.size(), {kNone, kNone, kNone});
  const std::vector<TriangleSide> sides = sorted_sides(triangles_);
  const auto across = [](const TriangleSide& side, auto& list) -> Index& {
    return list[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.corner)];
  };
  for (std::size_t n = 0; n + 1 < sides.size(); ++n) {
    const TriangleSide &one = sides[n], &other = sides[n + 1];
    if (one.ends != other.ends) continue;
    across(one, across_) = across(other, triangles_);
    across(other, across_) = across(one, triangles_);
  }
}

/// Whether the nearest point of a triangle is the nearest of the surface around it: at a border
/// that another triangle goes on from, nearer to the particle, it is that one's to respond.
/// @param particles  the one that is near, and the triangle's corners
template <class Real>
bool ClothGuard<Real>::owns_nearest(Index triangle, const std::array<Index, 4>& particles,
                                    const PairSeparation<Real>& s) const {
  Quad<Real> nearest;
  std::size_t corner = 3, zeros = 0, kept = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    nearest += legal_[static_cast<std::size_t>(particles[k + 1])] * -s.weight[k + 1];
    if (s.weight[k + 1] == 0) {
      corner = k;
      ++zeros;
    } else {
      kept = k;
    }
  }
  const Quad<Real> away = legal_[static_cast<std::size_t>(particles[0])] - nearest;
  const auto leads_nearer = [&](Index i) {
    return i != particles[0] && dot(away, legal_[static_cast<std::size_t>(i)] - nearest) > 0;
  };
  if (zeros == 1) {
    const Index other = across_[static_cast<std::size_t>(triangle)][corner];
    return other == kNone || !leads_nearer(other);
  }
  if (zeros != 2) return true;
  const auto i = static_cast<std::size_t>(particles[kept + 1]);
  const auto around = neighbours_.of(i);
  return std::none_of(around.begin(), around.end(),
                      [&](const auto& neighbour) { return leads_nearer(neighbour.particle); });
}

#define WEFT_INSTANTIATE(Real)                                                     \
  template void ClothGuard<Real>::find_who_is_across();                            \
  template bool ClothGuard<Real>::owns_nearest(Index, const std::array<Index, 4>&, \
                                               const PairSeparation<Real>&) const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
