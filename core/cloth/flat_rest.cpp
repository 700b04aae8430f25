// Tells a flat mesh from one that is curved at rest.

#include "core/cloth/flat_rest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cloth/constants.h"
#include "core/cloth/edge_sides.h"
#include "core/cloth/pieces.h"

namespace weft {
namespace {

/// Extent of a piece of a mesh along its normal, and the length of its edges.
struct PieceShape {
  Vec3d normal = Vec3d::Zero();             ///< sum of its triangles' areas, all on one side [m^2]
  double low = INFINITY, high = -INFINITY;  ///< along the normal [m]
  double edges = 0;                         ///< length of all [m]
  std::size_t edge_count = 0;
};

/// Whether the triangles at an edge lie on each other. One that is next to none of the other may
/// have come over the edge by rounding.
/// @param at  place of a particle [m]
template <class At>
bool folds_over(const EdgeSides& edge, const At& at) {
  if (edge.is_border()) return false;
  const Vec3d start = at(edge.ends[0]), along = (at(edge.ends[1]) - start).normalized();
  const auto out = [&](Index opposite) -> Vec3d {
    const Vec3d to = at(opposite) - start;
    return to - along * along.dot(to);
  };
  const Vec3d first = out(edge.opposite[0]), second = out(edge.opposite[1]);
  const auto [low, high] = std::minmax({first.norm(), second.norm()});
  return first.dot(second) > 0 && low > kLeastFold * high;
}

}  // namespace

template <class Real>
bool lies_flat(const ClothModel<Real>& model) {
  const std::vector<Index> piece_of = pieces_along(model.edges, model.rest_positions.size());
  std::vector<PieceShape> pieces(piece_of.size());
  const auto at = [&](Index i) -> Vec3d {
    return model.rest_positions[static_cast<std::size_t>(i)].template cast<double>();
  };
  const std::vector<EdgeSides> edges = sides_of(model.triangles);
  if (std::any_of(edges.begin(), edges.end(),
                  [&](const EdgeSides& edge) { return folds_over(edge, at); }))
    return false;
  const auto piece = [&](Index i) -> PieceShape& {
    return pieces[static_cast<std::size_t>(piece_of[static_cast<std::size_t>(i)])];
  };
  for (const Triangle& t : model.triangles) {
    const Vec3d area = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    Vec3d& normal = piece(t[0]).normal;
    normal += normal.dot(area) < 0 ? (-area).eval() : area;
  }
  for (const Edge& edge : model.edges) {
    piece(edge[0]).edges += (at(edge[1]) - at(edge[0])).norm();
    ++piece(edge[0]).edge_count;
  }
  double farthest = 0;
  for (std::size_t i = 0; i < piece_of.size(); ++i) {
    const Vec3d x = at(static_cast<Index>(i));
    PieceShape& own = piece(static_cast<Index>(i));
    const double height = own.normal.normalized().dot(x);
    own.low = std::min(own.low, height);
    own.high = std::max(own.high, height);
    farthest = std::max(farthest, x.cwiseAbs().maxCoeff());
  }
  const double rounding =
      farthest * static_cast<double>(std::numeric_limits<Real>::epsilon()) * kRoundingsOfFlat;
  return std::all_of(pieces.begin(), pieces.end(), [&](const PieceShape& p) {
    return p.edge_count == 0 ||
           p.high - p.low <= kFlatRest * p.edges / static_cast<double>(p.edge_count) + rounding;
  });
}

template bool lies_flat(const ClothModel<float>&);
template bool lies_flat(const ClothModel<double>&);

}  // namespace weft
